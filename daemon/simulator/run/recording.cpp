#include "daemon/simulator/run/recording.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <system_error>
#include <utility>

#include "core/io/pcd_writer.hpp"
#include "daemon/simulator/parallel.hpp"
#include "daemon/simulator/random.hpp"
#include "daemon/simulator/run/departures.hpp"
#include "daemon/simulator/run/site_config.hpp"
#include "lidar_drivers/pcap_writer.hpp"

namespace hulltrack {
namespace {

namespace fs = std::filesystem;

constexpr Nanoseconds kMargin = std::chrono::milliseconds(500);
constexpr Nanoseconds kPollPeriod = std::chrono::milliseconds(20);
constexpr Nanoseconds kTruthPeriod = std::chrono::milliseconds(10);

std::int64_t utc_ns(Nanoseconds time) { return to_ns(SimulatedBerth::kEpoch + time); }

Eigen::Vector3d in_degrees(const Eigen::Vector3d& rpy) {
  return rpy.unaryExpr([](double r) { return degrees(r); });
}

/// Files on their way into a folder: under a temporary name until commit(), gone without it.
class PendingFiles {
 public:
  explicit PendingFiles(fs::path folder) : folder_(std::move(folder)) {}
  PendingFiles(const PendingFiles&) = delete;
  PendingFiles& operator=(const PendingFiles&) = delete;
  ~PendingFiles() {
    std::error_code ignored;
    for (const std::string& name : names_) fs::remove(temporary(name), ignored);
  }

  /// Where to write the file that shall be called `name`.
  fs::path add(const std::string& name) {
    names_.push_back(name);
    return temporary(name);
  }

  Result<void> commit() {
    for (const std::string& name : names_) {
      std::error_code failure;
      fs::rename(temporary(name), folder_ / name, failure);
      if (failure) return Error{(folder_ / name).string() + ": cannot be put in place: " + failure.message()};
    }
    names_.clear();
    return {};
  }

 private:
  [[nodiscard]] fs::path temporary(const std::string& name) const { return folder_ / (name + ".part"); }

  fs::path folder_;
  std::vector<std::string> names_;
};

Result<void> prepare_folder(const fs::path& folder, bool overwrite) {
  std::error_code failure;
  fs::create_directories(folder, failure);
  if (failure) return Error{folder.string() + ": cannot be made: " + failure.message()};
  const bool empty = fs::is_empty(folder, failure);
  if (failure) return Error{folder.string() + ": cannot be read: " + failure.message()};
  if (!empty && !overwrite)
    return Error{folder.string() +
                 ": is not empty; choose another folder, or --force to replace the recording in it"};
  return {};
}

template <typename Row>
Result<void> write_table(const fs::path& file, const std::vector<Row>& rows) {
  auto writer = CsvWriter<Row>::create(file);
  if (!writer) return writer.error();
  for (const Row& row : rows)
    if (auto written = writer->write(row); !written) return written;
  return writer->close();
}

Result<void> write_text(const fs::path& file, const std::string& text) {
  std::FILE* stream = std::fopen(file.c_str(), "wb");
  if (stream == nullptr)
    return Error{file.string() + ": cannot be created: " + std::generic_category().message(errno)};
  const bool written = std::fwrite(text.data(), 1, text.size(), stream) == text.size();
  const bool closed = std::fclose(stream) == 0;
  if (!written || !closed)
    return Error{file.string() + ": cannot be written: " + std::generic_category().message(errno)};
  return {};
}

/// Sensors as delivered broadcast.
UdpEndpoints broadcast(const LidarConfig& lidar, std::size_t index, bool information) {
  const std::uint16_t port = information ? lidar.information_port : lidar.port;
  return {.source_ip = recorded_address(index),
          .source_port = port,
          .destination_ip = 0xFFFFFFFFU,
          .destination_port = port};
}

struct Cast {
  SimulatedBerth::Packet bytes;
  std::size_t frame = 0;    // in which it was sent
  std::size_t returns = 0;  // of these lie farther than a window's cover
};

Cast cast(const SimulatedBerth& berth, const Departure& departure) {
  constexpr double kBeyondWindow = 1.0;  // m
  const SimulatedLidar& lidar = berth.lidars()[departure.lidar];
  const auto frame = static_cast<std::size_t>(departure.time / SimulatedBerth::kFramePeriod);
  if (!departure.packet) return {bytes_of(berth, departure), frame};
  const std::vector<sim::LaserReturn> returns = lidar.returns(*departure.packet);
  const auto seen = std::ranges::count_if(
      returns, [](const sim::LaserReturn& echo) { return echo.range >= kBeyondWindow; });
  return {lidar.encoder().encode(*departure.packet, returns), frame, static_cast<std::size_t>(seen)};
}

/// `returns_a_frame` gets the number of returns in each frame.
Result<void> write_capture(const fs::path& file, const SimulatedBerth& berth,
                           std::vector<std::size_t>& returns_a_frame, const ProgressCallback& progress) {
  auto writer = PcapWriter::create(file);
  if (!writer) return writer.error();
  returns_a_frame.assign(static_cast<std::size_t>(berth.frames()), 0);
  const std::vector<LidarConfig> lidars = berth.lidar_configs();
  constexpr std::size_t kBatch = 1024;
  std::vector<Cast> batch;
  Departures departures(berth);
  for (auto sent = departures.next(kBatch); !sent.empty(); sent = departures.next(kBatch)) {
    batch.resize(sent.size());
    for_each_index(batch.size(), [&](std::size_t i) { batch[i] = cast(berth, sent[i]); });
    for (std::size_t i = 0; i < batch.size(); ++i) {
      const UdpEndpoints ends = broadcast(lidars[sent[i].lidar], sent[i].lidar, !sent[i].packet);
      const MeasurementTime time = SimulatedBerth::kEpoch + sent[i].time;
      if (auto done = writer->write(time, ends, batch[i].bytes); !done) return done;
      returns_a_frame[batch[i].frame] += batch[i].returns;
    }
    const Nanoseconds end = berth.frames() * SimulatedBerth::kFramePeriod;
    if (!progress(to_seconds(sent.back().time) / to_seconds(end)))
      return Error{"interrupted; nothing was left in the folder"};
  }
  return writer->close();
}

std::string returns_table(const std::vector<std::size_t>& returns_a_frame) {
  std::string text = "t_ns,returns\n";
  for (std::size_t frame = 0; frame < returns_a_frame.size(); ++frame) {
    const Nanoseconds middle = static_cast<Nanoseconds::rep>(frame) * SimulatedBerth::kFramePeriod +
                               SimulatedBerth::kFramePeriod / 2;
    text += std::to_string(utc_ns(middle)) + "," + std::to_string(returns_a_frame[frame]) + "\n";
  }
  return text;
}

Result<void> write_calibrations(PendingFiles& files, const SimulatedBerth& berth) {
  for (std::size_t i = 0; i < berth.lidars().size(); ++i) {
    const std::string name = berth.lidar_config(i).calibration;
    if (name.empty()) continue;
    if (auto done = write_text(files.add(name), berth.lidars()[i].information().calibration); !done)
      return done;
  }
  return {};
}

Result<void> write_maps(PendingFiles& files, const SimulatedBerth& berth) {
  if (auto done = write_pcd(files.add("hull.pcd"), berth.map()); !done) return done;
  return write_pcd(files.add("quay.pcd"), berth.quay_map());
}

}  // namespace

std::vector<PlcCsvRow> recorded_plc(const SimulatedBerth& berth) {
  constexpr double kRequestJitter = 0.001;  // s, when the poll goes out
  constexpr double kStampJitter = 0.0005;   // s, the middle of a request against the PLC's own moment
  std::vector<PlcCsvRow> rows;
  const Nanoseconds end = berth.frames() * SimulatedBerth::kFramePeriod + kMargin;
  std::uint64_t poll = 0;
  for (Nanoseconds nominal = -kMargin; nominal <= end; nominal += kPollPeriod, ++poll) {
    RandomStream random(berth.options().seed, 700, poll);
    const auto jitter = [&](double s) { return Nanoseconds{std::llround(random.uniform(-s, s) * 1e9)}; };
    const Nanoseconds answered = nominal + jitter(kRequestJitter);
    const PlcPresented presented = berth.plc(answered);
    rows.push_back({utc_ns(answered + jitter(kStampJitter)), presented.joints.d_x,
                    degrees(presented.joints.theta_r), degrees(presented.joints.theta_p), presented.heartbeat,
                    0});
  }
  return rows;
}

std::vector<TruthRow> recorded_truth(const SimulatedBerth& berth) {
  std::vector<TruthRow> rows;
  const Nanoseconds end = berth.frames() * SimulatedBerth::kFramePeriod + kMargin;
  for (Nanoseconds time = -kMargin; time <= end; time += kTruthPeriod) {
    const ShipPose pose = berth.truth(time);
    rows.push_back({utc_ns(time), pose.displacement, in_degrees(pose.rpy), berth.bend(time)});
  }
  return rows;
}

Result<void> write_recording(const SimulatedBerth& berth, const fs::path& folder, bool overwrite,
                             const ProgressCallback& progress) {
  if (auto ready = prepare_folder(folder, overwrite); !ready) return ready;
  PendingFiles files(folder);
  if (auto done = write_text(files.add("hulltrackd.toml"), site_config(berth, {})); !done) return done;
  if (auto done = write_calibrations(files, berth); !done) return done;
  if (auto done = write_table(files.add("truth.csv"), recorded_truth(berth)); !done) return done;
  if (auto done = write_table(files.add("plc.csv"), recorded_plc(berth)); !done) return done;
  if (auto done = write_maps(files, berth); !done) return done;
  if (!progress(0.0)) return Error{"interrupted; nothing was left in the folder"};
  std::vector<std::size_t> returns;
  if (auto done = write_capture(files.add("lidar.pcap"), berth, returns, progress); !done) return done;
  if (auto done = write_text(files.add("returns.csv"), returns_table(returns)); !done) return done;
  return files.commit();
}

Result<void> write_site_files(const SimulatedBerth& berth, const fs::path& folder, bool overwrite,
                              const std::string& config_text) {
  if (auto ready = prepare_folder(folder, overwrite); !ready) return ready;
  PendingFiles files(folder);
  if (auto done = write_text(files.add("hulltrackd.toml"), config_text); !done) return done;
  if (auto done = write_calibrations(files, berth); !done) return done;
  if (auto done = write_maps(files, berth); !done) return done;
  return files.commit();
}

}  // namespace hulltrack
