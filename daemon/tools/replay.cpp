// `hulltrack replay`: a recording through the very code of the service, faster than real time.
#include <unistd.h>
#include <chrono>
#include <cstdio>
#include <filesystem>
#include <memory>
#include <string>

#include "core/io/plc_csv.hpp"
#include "daemon/config/read_config.hpp"
#include "daemon/pipeline/frame_pipeline.hpp"
#include "daemon/pipeline/load_map.hpp"
#include "daemon/pipeline/publication.hpp"
#include "daemon/pipeline/quay_file.hpp"
#include "daemon/replay/csv_file.hpp"
#include "daemon/replay/frame_csv.hpp"
#include "daemon/replay/joint_csv.hpp"
#include "daemon/replay/recording_player.hpp"
#include "daemon/replay/replay_summary.hpp"
#include "daemon/tools/tools.hpp"
#include "lidar_drivers/model_registry.hpp"

namespace hulltrack {
namespace {

struct ReplayOptions {
  std::string folder;
  std::string config;
  std::string csv;
  std::string joints;
  std::string metrics = "visible";
  bool no_timing = false;
  bool quiet = false;
};

/// "12 %, 8 s left" on one line of standard error, once a second, if somebody is watching.
class Progress {
 public:
  explicit Progress(bool wanted) : shown_(wanted && isatty(STDERR_FILENO) != 0) {}
  ~Progress() {
    if (shown_) {
      std::fprintf(stderr, "\r\033[K");
    }
  }
  Progress(const Progress&) = delete;
  Progress& operator=(const Progress&) = delete;

  void show(double share, std::uint32_t frame) {
    const auto now = std::chrono::steady_clock::now();
    if (!shown_ || now - last_ < std::chrono::seconds(1)) {
      return;
    }
    last_ = now;
    const double elapsed = std::chrono::duration<double>(now - start_).count();
    const double left = share > 0.0 ? elapsed * (1.0 - share) / share : 0.0;
    std::fprintf(stderr, "\rframe %u, %.0f %%, %.0f s left \033[K", frame, 100.0 * share, left);
  }

 private:
  bool shown_;
  std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
  std::chrono::steady_clock::time_point last_ = start_;
};

template <typename T>
T value_or_throw(Result<T> result) {
  if (!result) {
    throw ToolError(result.error().message);
  }
  return std::move(result).value();
}

void must(const Result<void>& done) {
  if (!done) {
    throw ToolError(done.error().message);
  }
}

MetricsScope metrics_scope(const std::string& word) {
  if (word == "visible") return MetricsScope::visible_subset;
  if (word == "full") return MetricsScope::visible_full;
  if (word == "paper") return MetricsScope::whole_map;
  throw ToolError(kExitUsage, "--metrics " + word + ": must be visible, full or paper");
}

Config load_config(const ReplayOptions& options) {
  const std::filesystem::path file = options.config.empty()
                                         ? std::filesystem::path(options.folder) / "hulltrackd.toml"
                                         : std::filesystem::path(options.config);
  if (options.config.empty() && !std::filesystem::exists(file)) {
    throw ToolError(file.string() + ": is missing; name the configuration with --config");
  }
  ConfigReading reading = read_config(file, lidar_models());
  if (!reading.config) {
    std::string text;
    for (const Problem& problem : reading.problems) {
      text += text.empty() ? "" : "\n";
      text += to_string(problem);
    }
    throw ToolError(text);
  }
  reading.config->tracker.metrics_scope = metrics_scope(options.metrics);
  return std::move(*reading.config);
}

std::vector<TruthRow> load_truth(const std::filesystem::path& folder) {
  const std::filesystem::path file = folder / "truth.csv";
  return std::filesystem::exists(file) ? value_or_throw(read_truth_csv(file)) : std::vector<TruthRow>{};
}

/// Warnings go to standard error; what refuses the map is the error.
std::shared_ptr<const HullMap> map_of(const Config& config) {
  LoadedMap loaded = load_map(config.map_file, config.tracker);
  std::string refusals;
  for (const MapFinding& finding : loaded.findings) {
    const bool of_map = finding.key == "hull.map";  // its messages begin with the file's name
    const std::string line = (of_map ? "" : finding.key + ": ") + finding.message;
    if (finding.refused) {
      refusals += (refusals.empty() ? "" : "\n") + line;
    } else {
      std::fprintf(stderr, "%s\n", line.c_str());
    }
  }
  if (!loaded.map) {
    throw ToolError(refusals);
  }
  return std::move(loaded.map);
}

std::shared_ptr<const QuayMap> load_quay(const std::filesystem::path& file) {
  QuayFile quay = value_or_throw(read_quay_file(file));
  if (!quay.remark.empty()) {
    std::fprintf(stderr, "%s\n", quay.remark.c_str());
  }
  return quay.map;
}

std::optional<CsvFile> table(const std::string& file, const char* header, const char* option) {
  return file.empty() ? std::nullopt : std::optional(value_or_throw(CsvFile::create(file, header, option)));
}

/// The frame with the state, health and faults that the registers have. The pose and the distances stay the
/// frame's, and so does the reason, unless the pose's age alone takes health.
TrackResult as_published(TrackResult track, const WriteBlock& block) {
  if (track.health && !block.health) {
    track.reason = "the pose is older than health.max_age_ms";
  }
  track.state = block.state;
  track.health = block.health;
  track.faults = block.faults;
  return track;
}

void replay(const ReplayOptions& options) {
  must(check_recording_folder(options.folder));
  const Config config = load_config(options);
  std::unique_ptr<RecordingPlayer> player = value_or_throw(RecordingPlayer::open(options.folder, config));
  ReplaySummary summary(load_truth(options.folder), config.tracker.hull.max_speed);
  FramePipeline pipeline(config, map_of(config), load_quay(config.quay_file));
  Publication publication(config.tracker.health.max_age);
  std::optional<CsvFile> csv = table(options.csv, kFrameCsvHeader, "--csv");
  std::optional<CsvFile> joints = table(options.joints, kJointCsvHeader, "--joints");

  Scan scan;
  std::string broken_off;
  {
    Progress progress(!options.quiet);
    for (;;) {
      const Result<bool> more = player->next(scan);
      if (!more) {
        broken_off = more.error().message;
        break;
      }
      if (!*more) {
        break;
      }
      FrameReport report = pipeline.process(scan, player->joints(), player->inputs());
      player->judged(report.track);
      publication.frame(report.track, scan.end, report.processing);
      report.track = as_published(std::move(report.track), publication.block(player->context(), scan.end));
      const double ms = to_milliseconds(report.processing);
      summary.add(report.track, ms);
      if (csv) {
        must(csv->write(frame_csv_line(report.track, options.no_timing ? std::nullopt : std::optional(ms))));
      }
      if (joints) {
        must(joints->write(joint_csv_line(report.track)));
      }
      progress.show(player->share(), scan.frame_number);
    }
  }
  if (csv) {
    must(csv->close());
  }
  if (joints) {
    must(joints->close());
  }
  if (!options.quiet && !summary.empty()) {
    std::fputs(
        (summary.text(!options.no_timing) + player->explain_joints() + player->explain_lidars()).c_str(),
        stderr);
  }
  if (!broken_off.empty()) {
    throw ToolError(broken_off);
  }
}

}  // namespace

void add_replay(CLI::App& app) {
  auto options = std::make_shared<ReplayOptions>();
  CLI::App* command = app.add_subcommand(
      "replay", "Track a recording with the code of the service; per-frame CSV and summary.");
  command
      ->add_option("REC", options->folder,
                   "recording folder: lidar.pcap, plc.csv and, if simulated, truth.csv")
      ->required();
  command->add_option("--config", options->config, "configuration; default REC/hulltrackd.toml");
  command->add_option("--csv", options->csv, "write one line a frame to this file");
  command->add_option("--joints", options->joints,
                      "write what the quay says of travel, slew and luff to this file, one line a frame");
  command
      ->add_option(
          "--metrics", options->metrics,
          "map points of the distances: visible (fixed subset, as in service), full (all visible), paper "
          "(whole map); Q1 decides on health, so full and paper can change states and health too")
      ->option_text("{visible,full,paper}")
      ->capture_default_str();
  command->add_flag("--no-timing", options->no_timing,
                    "leave the column ms empty, so that two runs compare byte for byte");
  command->add_flag("--quiet", options->quiet, "neither progress nor summary");
  command->footer("Example: hulltrack replay REC --csv frames.csv");
  command->callback([options] { replay(*options); });
}

}  // namespace hulltrack
