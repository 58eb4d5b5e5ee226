// The main of `hulltrackd`, the service: command line, start-up errors, exit codes.
//
// 0 stopped as asked, 1 it failed, 2 wrong command line, 78 an error in the configuration, a calibration or
// the map. Start-up problems go to standard error, where the service manager collects them.
#include <poll.h>
#include <unistd.h>

#include <CLI/CLI.hpp>
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <filesystem>
#include <optional>
#include <string>

#include "core/base/text.hpp"
#include "daemon/config/read_config.hpp"
#include "daemon/log/syslog_sink.hpp"
#include "daemon/pipeline/live_time.hpp"
#include "daemon/service/preparer.hpp"
#include "daemon/service/reader.hpp"
#include "daemon/service/reload_desk.hpp"
#include "daemon/service/service.hpp"
#include "daemon/service/signals.hpp"
#include "lidar_drivers/model_registry.hpp"

namespace hulltrack {
namespace {

struct Options {
  std::string config = "/etc/hulltrackd/hulltrackd.toml";
  bool check_config = false;
  bool print_config = false;
  bool to_stderr = false;
  bool reload = false;
};

void print(const std::vector<Problem>& problems) {
  for (const Problem& problem : problems) {
    std::fprintf(stderr, "%s\n", to_string(problem).c_str());
  }
}

int print_values(const std::string& file) {
  const ConfigReading reading = read_config(file, lidar_models());
  if (!reading.config) {
    print(reading.problems);
    return kExitConfig;
  }
  std::fputs(print_config(*reading.config).c_str(), stdout);
  return 0;
}

Preparation prepared_for_check(const std::string& file) {
  Preparer preparer(file, {}, Preparer::Goal::check, steady_now());
  while (!preparer.result()) {
    pollfd entry{preparer.fd(), POLLIN, 0};
    poll(&entry, 1, 100);
    preparer.step(steady_now());
  }
  return *std::move(preparer.result());
}

int check(const std::string& file) {
  const Preparation preparation = prepared_for_check(file);
  if (!preparation.prepared) {
    print(preparation.problems);
    return preparation.may_pass ? kExitFailed : kExitConfig;
  }
  const Prepared& prepared = *preparation.prepared;
  std::printf("%s: good: %s, map %s with %s\n", file.c_str(),
              counted(prepared.config.lidars.size(), "LiDAR").c_str(), prepared.config.map_file.c_str(),
              counted(prepared.map_points, "point").c_str());
  if (!prepared.map_remark.empty()) {
    std::printf("%s\n", prepared.map_remark.c_str());
  }
  return 0;
}

/// RuntimeDirectory= of the unit, where one can be written; nothing for a service that is started by hand.
std::optional<std::filesystem::path> runtime_folder() {
  const char* const folder = std::getenv("RUNTIME_DIRECTORY");
  return folder != nullptr ? std::optional<std::filesystem::path>(folder) : std::nullopt;
}

int serve(const Options& options) {
  Signals signals;  // before the log's threads, which inherit the mask
  const bool log_to_stderr = options.to_stderr || isatty(STDERR_FILENO) == 1;
  SyslogSink log({}, log_to_stderr);  // until [log] is known
  try {
    Service service({.config_file = options.config, .runtime_folder = runtime_folder()}, signals, log);
    const int code = service.run();
    print(service.problems());
    return code;
  } catch (const std::exception& error) {
    log.write(LogLevel::error, error.what());
    if (!log_to_stderr) {
      std::fprintf(stderr, "hulltrackd: %s\n", error.what());
    }
    return kExitFailed;
  }
}

/// As long as one reading of the files may take (180 s, reader_process.hpp) and making the map (60 s); the
/// unit's TimeoutStartSec= is longer.
constexpr Nanoseconds kReloadPatience = std::chrono::minutes(4);

int reload() {
  const ReloadAnswer answer = ask_for_reload(runtime_folder().value_or("/run/hulltrackd"), kReloadPatience);
  std::fputs(answer.text.c_str(), answer.reloaded ? stdout : stderr);
  return answer.reloaded ? 0 : kExitFailed;
}

int run(const Options& options) {
  if (options.reload) {
    return reload();
  }
  if (options.print_config) {
    return print_values(options.config);
  }
  const int code = options.check_config ? check(options.config) : serve(options);
  if (Preparer::maps_in_the_making() > 0) {  // by a thread that must not see this process taken down
    std::fflush(nullptr);
    std::_Exit(code);
  }
  return code;
}

}  // namespace
}  // namespace hulltrack

int main(int argc, char** argv) {
  using namespace hulltrack;
  if (argc > 1 && argv[1] == kReaderFlag) {  // started by the service: not for people, not in --help
    return run_reader(argc - 1, argv + 1);
  }
  Options options;
  CLI::App app{"Tracks a moored ship's hull with the LiDAR on a ship loader and tells the loader's PLC."};
  app.name("hulltrackd");
  app.set_version_flag("--version", "hulltrackd " HULLTRACK_VERSION);
  app.add_option("--config", options.config, "Configuration file, hulltrackd.toml(5)")
      ->type_name("FILE")
      ->capture_default_str();
  auto* check = app.add_flag("--check-config", options.check_config,
                             "Read everything the service would read, name every problem, and exit");
  app.add_flag("--print-config", options.print_config, "Print the values in force as TOML, and exit")
      ->excludes(check);
  app.add_flag("--reload", options.reload,
               "Ask the running service to read its files again, wait, and tell what came of it");
  app.add_flag("--stderr", options.to_stderr, "Log to standard error too, as on a terminal");
  app.footer(
      "Manual: hulltrackd(8). Exit codes: 0 stopped, 1 failed, 2 command line, 78 configuration or map.");
  try {
    app.parse(argc, argv);
    return run(options);
  } catch (const CLI::Success& help_or_version) {
    return app.exit(help_or_version);
  } catch (const CLI::ParseError& wrong) {
    std::fprintf(stderr, "hulltrackd: %s\nTry: hulltrackd --help\n", wrong.what());
    return kExitUsage;
  } catch (const std::exception& error) {
    std::fprintf(stderr, "hulltrackd: %s\n", error.what());
    return kExitFailed;
  }
}
