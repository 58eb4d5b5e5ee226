// `hulltrack simulate`: a virtual berth with ground truth, as a recording folder or live on the network.
#include <charconv>
#include <chrono>
#include <cmath>
#include <csignal>
#include <cstdio>
#include <limits>
#include <map>
#include <memory>
#include <optional>
#include <string>

#include "daemon/simulator/run/live_run.hpp"
#include "daemon/simulator/run/recording.hpp"
#include "daemon/simulator/run/simulated_berth.hpp"
#include "daemon/simulator/run/site_config.hpp"
#include "daemon/tools/tools.hpp"

namespace hulltrack {
namespace {

struct SimulateOptions {
  SimulationOptions simulation;
  double seconds = 0.0;
  bool list = false;
  bool csv = false;
  bool overwrite = false;
  std::string out;         // recording folder; empty = live
  std::string config_out;  // folder for the live service's map and configuration
  std::string lidar_to = "127.0.0.1:2368";
  std::string joints;  // d_x,slew,luff of a parked loader
  std::string unplug;  // lidar@from[-to]
  bool no_plc = false;
  LiveOptions live;
};

volatile std::sig_atomic_t g_interrupted = 0;

void note_interrupt(int) { g_interrupted = 1; }

/// SIGINT and SIGTERM ask for a tidy end; a second one ends at once.
void watch_for_interrupts() {
  struct sigaction action {};
  action.sa_handler = note_interrupt;
  action.sa_flags = static_cast<int>(SA_RESETHAND);
  sigaction(SIGINT, &action, nullptr);
  sigaction(SIGTERM, &action, nullptr);
}

/// One line on standard error that is written over as the work goes on.
class ProgressLine {
 public:
  explicit ProgressLine(std::string what) : what_(std::move(what)) {}
  ~ProgressLine() {
    if (started_) std::fputc('\n', stderr);
  }
  ProgressLine(const ProgressLine&) = delete;
  ProgressLine& operator=(const ProgressLine&) = delete;

  /// The time to go is judged by the progress since the first call.
  void show(double share) {
    if (!started_) started_ = Start{Clock::now(), share};
    const double elapsed = std::chrono::duration<double>(Clock::now() - started_->time).count();
    const double done = share - started_->share;
    std::fprintf(stderr, "\r%s %3.0f %%", what_.c_str(), 100.0 * share);
    if (done > 0.0) std::fprintf(stderr, ", %.0f s to go   ", elapsed * (1.0 - share) / done);
  }

 private:
  using Clock = std::chrono::steady_clock;
  struct Start {
    Clock::time_point time;
    double share;
  };
  std::string what_;
  std::optional<Start> started_;
};

void list_scenarios(bool as_csv) {
  if (as_csv) std::puts("name,frames,mapped_ship,clear");
  for (const Scenario& scenario : scenarios()) {
    const std::string name(scenario.name);
    if (as_csv)
      std::printf("%s,%d,%d,%d\n", name.c_str(), scenario.frames, int{scenario.mapped_ship},
                  int{is_clear(scenario)});
    else
      std::printf("%-15s %s (%d frames)\n", name.c_str(), std::string(scenario.sentence).c_str(),
                  scenario.frames);
  }
}

void record(const SimulatedBerth& berth, const SimulateOptions& options) {
  watch_for_interrupts();
  Result<void> done;
  {
    ProgressLine line("simulating " + std::to_string(berth.frames()) + " frames");
    done = write_recording(berth, options.out, options.overwrite, [&](double share) {
      line.show(share);
      return g_interrupted == 0;
    });
  }
  if (!done) throw ToolError(done.error().message);
  std::fprintf(stderr, "%s holds %d frames; try: hulltrack replay %s --config %s/hulltrackd.toml\n",
               options.out.c_str(), berth.frames(), options.out.c_str(), options.out.c_str());
}

/// "HOST:PORT", the first of as many ports as there are LiDARs.
void parse_lidar_target(const std::string& text, std::size_t lidars, LiveOptions& live) {
  const auto colon = text.rfind(':');
  unsigned port = 0;
  const char* end = text.data() + text.size();
  const auto parsed = colon == std::string::npos ? std::from_chars_result{end, std::errc::invalid_argument}
                                                 : std::from_chars(text.data() + colon + 1, end, port);
  if (parsed.ec != std::errc{} || parsed.ptr != end || port == 0 || port + lidars - 1 > 65535)
    throw ToolError(kExitUsage,
                    "--lidar-to " + text +
                        ": give ADDRESS:PORT, 127.0.0.1:2368 for example; a second LiDAR's port follows, "
                        "65535 is the last one");
  live.lidar_host = text.substr(0, colon);
  live.lidar_port = static_cast<std::uint16_t>(port);
}

/// "D_X,SLEW,LUFF" in m and deg.
Joints parse_joints(const std::string& text) {
  double d_x = 0.0;
  double slew = 0.0;
  double luff = 0.0;
  int read = 0;
  if (std::sscanf(text.c_str(), "%lf,%lf,%lf%n", &d_x, &slew, &luff, &read) != 3 ||
      text.size() != static_cast<std::size_t>(read) || !std::isfinite(d_x + slew + luff))
    throw ToolError(kExitUsage,
                    "--joints " + text + ": give travel in m, slew and luff in deg, 3.5,90,1 for example");
  return {d_x, radians(slew), radians(luff)};
}

/// "LIDAR@FROM" or "LIDAR@FROM-TO", LIDAR from 1 on, times in s.
Unplugged parse_unplugged(const std::string& text) {
  int lidar = 0;
  double from = 0.0;
  double to = std::numeric_limits<double>::infinity();
  int read = 0;
  const bool begun = std::sscanf(text.c_str(), "%d@%lf%n", &lidar, &from, &read) == 2;
  const char* rest = text.c_str() + read;
  int read_rest = 0;
  const bool ends = begun && *rest == '-' && std::sscanf(rest + 1, "%lf%n", &to, &read_rest) == 1 &&
                    rest[1 + read_rest] == '\0';
  if (!begun || !(*rest == '\0' || ends) || lidar < 1 || !(from >= 0.0) || !std::isfinite(from) ||
      !(to > from))
    throw ToolError(kExitUsage, "--unplug " + text +
                                    ": give the LiDAR's place in the list and the second when its cable is "
                                    "pulled, 2@10, or also when it is back, 2@10-15");
  return {static_cast<std::size_t>(lidar) - 1, {.first = from, .length = to - from}};
}

std::string simulated_models() {
  std::string names;
  for (const SensorTraits& sensor : simulated_sensors())
    names += (names.empty() ? "" : ", ") + std::string(sensor.model);
  return names;
}

Result<void> write_config(const SimulatedBerth& berth, const SimulateOptions& options,
                          std::uint16_t plc_port) {
  if (options.config_out.empty()) return {};
  const SiteAddresses addresses{
      .plc_host = "127.0.0.1", .plc_port = plc_port, .lidar_port = options.live.lidar_port};
  std::fprintf(stderr, "surveying the ship for %s/hull.pcd\n", options.config_out.c_str());
  if (auto done =
          write_site_files(berth, options.config_out, options.overwrite, site_config(berth, addresses));
      !done)
    return done;
  std::fprintf(stderr, "start the service: hulltrackd --stderr --config %s/hulltrackd.toml\n",
               options.config_out.c_str());
  return {};
}

void run_on_network(const SimulatedBerth& berth, const SimulateOptions& options) {
  watch_for_interrupts();
  const LiveHooks hooks{
      .listening = [&](std::uint16_t plc_port) { return write_config(berth, options, plc_port); },
      .show =
          [](const std::string& line) {
            std::puts(line.c_str());
            std::fflush(stdout);
          },
      .keep_going = [] { return g_interrupted == 0; }};
  if (auto done = run_live(berth, options.live, hooks); !done) throw ToolError(done.error().message);
}

void run(SimulateOptions options) {
  if (options.list) return list_scenarios(options.csv);
  constexpr double kFrameRate = 10.0;
  if (options.seconds > 0.0)
    options.simulation.frames = static_cast<int>(std::lround(options.seconds * kFrameRate));
  if (!options.joints.empty()) options.simulation.parked = parse_joints(options.joints);
  if (!options.unplug.empty()) options.simulation.unplugged = parse_unplugged(options.unplug);
  parse_lidar_target(options.lidar_to, options.simulation.lidar_models.size(), options.live);
  options.live.with_plc = !options.no_plc;
  const auto berth = SimulatedBerth::create(options.simulation);
  if (!berth) throw ToolError(kExitUsage, berth.error().message);
  if (options.out.empty())
    run_on_network(**berth, options);
  else
    record(**berth, options);
}

}  // namespace

void add_simulate(CLI::App& app) {
  auto options = std::make_shared<SimulateOptions>();
  SimulationOptions& simulation = options->simulation;
  LiveOptions& live = options->live;
  CLI::App* command = app.add_subcommand(
      "simulate",
      "A virtual ship, quay and loader: LiDAR datagrams and PLC values with ground truth.\n"
      "With --out a recording folder, without it live on the network in real time.");
  command->footer(
      "Examples:\n"
      "  hulltrack simulate --scenario berth --seed 7 --out REC     a recording with ground truth\n"
      "  hulltrack simulate --scenario berth --config-out SITE      live; then: hulltrackd --config "
      "SITE/hulltrackd.toml\n"
      "  hulltrack simulate --lidar hesai_xt32 --lidar hesai_xt32 --unplug 2@10 --out REC\n"
      "                                                             two LiDARs, one is cut off after 10 s\n"
      "  hulltrack simulate --no-plc --joints 3.5,90,1              only the LiDAR; your PLC presents these "
      "joints");
  auto* list = command->add_flag("--list", options->list, "Name the scenarios and exit");
  command->add_flag("--csv", options->csv, "With --list: name,frames,mapped_ship,clear for scripts")
      ->needs(list);
  command->add_option("--scenario", simulation.scenario, "What the ship does, see --list")
      ->capture_default_str();
  command
      ->add_option("--lidar", simulation.lidar_models,
                   "LiDAR model; give it twice for one on either side of the chute: " + simulated_models())
      ->capture_default_str();
  command->add_option(
      "--unplug", options->unplug,
      "LIDAR@FROM[-TO]: that LiDAR, 1 or 2, sends nothing from second FROM on (to second TO)");
  const std::map<std::string, ReturnMode> modes = {
      {"strongest", ReturnMode::strongest}, {"last", ReturnMode::last}, {"dual", ReturnMode::dual}};
  command
      ->add_option("--returns", simulation.return_mode, "Echoes that the LiDAR reports (default: strongest)")
      ->transform(CLI::Transformer(modes))
      ->option_text("{strongest,last,dual}");
  auto* frames = command
                     ->add_option("--frames", simulation.frames,
                                  "Length of the run at 10 Hz (default: the scenario's own)")
                     ->check(CLI::Range(1, SimulatedBerth::kMaxFrames));
  command->add_option("--seconds", options->seconds, "The same in seconds")
      ->check(CLI::Range(0.1, 3600.0))
      ->excludes(frames);
  command
      ->add_option("--leave-at", simulation.leave_at,
                   "Seconds after which the ship gets under way (berth, shift; default: the scenario's own)")
      ->check(CLI::Range(0.0, 3600.0));
  command->add_option("--seed", simulation.seed, "The same seed gives the same bytes")
      ->check([](const std::string& text) {
        return text.starts_with('-') ? text + " is negative; give a whole number from 0 on" : std::string();
      })
      ->capture_default_str();
  command->add_option("--joints", options->joints, "D_X,SLEW,LUFF in m and deg: the loader is parked there");
  command->add_flag("!--no-quay-map", simulation.configure_quay_map,
                    "The configuration does without the map of the quay");
  command->add_flag("--force", options->overwrite, "Replace what is in the folder of --out or --config-out");

  auto* out = command->add_option(
      "--out", options->out,
      "Folder for lidar.pcap, plc.csv, truth.csv, returns.csv, hull.pcd, quay.pcd, hulltrackd.toml");
  command
      ->add_option("--config-out", options->config_out,
                   "Live: folder for the map and a matching hulltrackd.toml")
      ->excludes(out);
  command
      ->add_option("--lidar-to", options->lidar_to,
                   "Live: ADDRESS:PORT that the datagrams go to; those of a second LiDAR to the next port")
      ->capture_default_str()
      ->excludes(out);
  auto* port = command->add_option("--plc-port", live.plc_port, "Live: Modbus/TCP port of the loader's PLC")
                   ->capture_default_str()
                   ->excludes(out);
  command->add_option("--plc-bind", live.plc_bind, "Live: address that the PLC listens on")
      ->capture_default_str()
      ->excludes(out);
  auto* wait =
      command->add_flag("--wait", live.wait_for_service, "Live: begin when the service first reads the PLC")
          ->excludes(out);
  command->add_flag("--no-plc", options->no_plc, "Live: no PLC, somebody else's serves the service")
      ->excludes(out)
      ->excludes(port)
      ->excludes(wait);
  command->callback([options] { run(*options); });
}

}  // namespace hulltrack
