#include "daemon/service/preparer.hpp"

#include <atomic>
#include <exception>
#include <thread>
#include <utility>

#include "daemon/service/prepared_files.hpp"
#include "lidar_drivers/model_registry.hpp"

namespace hulltrack {
namespace {

std::atomic<int> g_maps_in_the_making = 0;

Preparation refused(Problem problem) { return {.prepared = {}, .problems = {std::move(problem)}}; }

/// The calibrations of `config` as files that cannot change, named by it from now on.
std::vector<std::shared_ptr<const MemoryFile>> calibrations_in_memory(const PreparedFiles& files,
                                                                      Config& config) {
  std::vector<std::shared_ptr<const MemoryFile>> calibrations;
  for (std::size_t i = 0; i < config.lidars.size(); ++i) {
    if (!config.lidars[i].calibration.empty()) {
      calibrations.push_back(std::make_shared<const MemoryFile>("calibration", files.calibrations[i]));
      config.lidars[i].calibration = calibrations.back()->path().string();
    }
  }
  return calibrations;
}

Result<PreparedFiles> taken_from(MemoryFile file) {
  file.seal();
  const MappedBytes mapped(file);
  return parse_prepared_files(mapped.bytes());
}

Preparation make_ready(MemoryFile file, const std::optional<ConfigReading>& reading,
                       const std::filesystem::path& config_file, Preparer::Goal goal) {
  Result<PreparedFiles> files = taken_from(std::move(file));
  if (!files) {
    return refused({config_file.string(), 0, files.error().message});
  }
  if (!files->problems.empty()) {
    return {.prepared = {}, .problems = std::move(files->problems)};
  }
  if (!reading || !reading->config || reading->config->lidars.size() != files->calibrations.size()) {
    return refused({config_file.string(), 0, "what was read does not belong together; try again"});
  }
  Prepared prepared{.config = *reading->config,
                    .map = nullptr,
                    .quay = nullptr,
                    .map_remark = std::move(files->map_remark),
                    .map_points = files->map_H.size()};
  prepared.calibrations = calibrations_in_memory(*files, prepared.config);
  if (goal == Preparer::Goal::run) {
    prepared.map = std::make_shared<const HullMap>(std::move(files->map_H));
    prepared.quay = files->quay_W.empty() ? nullptr : std::make_shared<const QuayMap>(files->quay_W);
  }
  return {.prepared = std::move(prepared), .problems = {}};
}

/// `work` in a thread that nobody waits for.
std::future<Preparation> in_a_thread(std::packaged_task<Preparation()> work) {
  std::future<Preparation> result = work.get_future();
  ++g_maps_in_the_making;
  std::thread([task = std::move(work)]() mutable {
    task();
    --g_maps_in_the_making;
  }).detach();
  return result;
}

}  // namespace

Preparer::Preparer(std::filesystem::path config_file, const ReaderSetup& setup, Goal goal, SteadyTime now)
    : config_file_(std::move(config_file)), goal_(goal) {
  reader_.emplace(setup, config_file_, now);
}

int Preparer::maps_in_the_making() { return g_maps_in_the_making; }

void Preparer::step(SteadyTime now) {
  try {
    if (reader_) {
      reader_->step(now);
      if (reader_->configuration_read() && !configuration_) {
        read_configuration();
      }
      const bool awaited = reader_->configuration_read() && !configuration_ && !reader_->failure();
      if (reader_->ended() && !awaited) {
        reader_ended();
      }
    } else if (making_.valid() && making_.wait_for(std::chrono::seconds(0)) == std::future_status::ready) {
      result_ = making_.get();
    }
  } catch (const std::exception& error) {
    refuse({config_file_.string(), 0, std::string("cannot be made ready: ") + error.what()}, true);
  }
}

void Preparer::read_configuration() {
  if (!reader_->configuration().try_seal()) {
    return;  // in the next step: whoever calls feeds a watchdog
  }
  const MappedBytes text(reader_->configuration());
  configuration_ = parse_config(text.bytes(), config_file_, lidar_models());
}

void Preparer::reader_ended() {
  if (reader_->failure()) {
    refuse(problem_of_reader(), reader_->was_killed());
    return;
  }
  making_ = in_a_thread(
      std::packaged_task<Preparation()>([file = std::make_shared<MemoryFile>(std::move(reader_->files())),
                                         reading = configuration_, config_file = config_file_, goal = goal_] {
        return make_ready(std::move(*file), reading, config_file, goal);
      }));
  reader_.reset();
}

Problem Preparer::problem_of_reader() const {
  const std::string how = " " + *reader_->failure();
  if (!configuration_ || reader_->at() <= PreparationStep::configuration_read) {
    return {config_file_.string(), 0, "reading it" + how};
  }
  if (reader_->at() == PreparationStep::calibration) {
    const std::size_t lidar = std::min(reader_->lidar(), configuration_->readable.lidars.size() - 1);
    return configuration_->problem_with(
        config_file_, "lidar." + std::to_string(lidar) + ".calibration",
        configuration_->readable.lidars.at(lidar).calibration + ": reading it" + how);
  }
  if (reader_->at() == PreparationStep::quay) {
    return configuration_->problem_with(config_file_, "quay.map",
                                        configuration_->readable.quay_file.string() + ": reading it" + how);
  }
  const std::string map = configuration_->readable.map_file.string();
  return configuration_->problem_with(
      config_file_, "hull.map",
      map + (reader_->at() == PreparationStep::map ? ": reading it" : ": making the tracker's map of it") +
          how);
}

void Preparer::refuse(Problem problem, bool may_pass) {
  reader_.reset();
  making_ = {};
  result_ = refused(std::move(problem));
  result_->may_pass = may_pass;
}

}  // namespace hulltrack
