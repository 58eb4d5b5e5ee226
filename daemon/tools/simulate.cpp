// `hulltrack simulate`: a virtual berth with ground truth, as a recording folder or live on the network.
#include <chrono>
#include <csignal>
#include <cstdio>
#include <memory>
#include <optional>
#include <string>

#include "daemon/simulator/recording.hpp"
#include "daemon/simulator/simulated_berth.hpp"
#include "daemon/tools/tools.hpp"

namespace hulltrack {
namespace {

struct SimulateOptions {
  SimulationOptions simulation;
  bool list = false;
  bool overwrite = false;
  std::string out;
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
  ~ProgressLine() { std::fputc('\n', stderr); }
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

void list_scenarios() {
  for (const Scenario& scenario : scenarios())
    std::printf("%-12s %s (%d frames)\n", std::string(scenario.name).c_str(),
                std::string(scenario.sentence).c_str(), scenario.frames);
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

void run(const SimulateOptions& options) {
  if (options.list) return list_scenarios();
  const auto berth = SimulatedBerth::create(options.simulation);
  if (!berth) throw ToolError(kExitUsage, berth.error().message);
  record(**berth, options);
}

}  // namespace

void add_simulate(CLI::App& app) {
  auto options = std::make_shared<SimulateOptions>();
  CLI::App* command = app.add_subcommand(
      "simulate", "A virtual ship, quay and loader: LiDAR datagrams and PLC values with ground truth.");
  command->footer("Example: hulltrack simulate --scenario berth --frames 869 --seed 7 --out REC");
  command->add_flag("--list", options->list, "Name the scenarios and exit");
  command->add_option("--scenario", options->simulation.scenario, "What the ship does, see --list")
      ->capture_default_str();
  command
      ->add_option("--lidar", options->simulation.lidar_model,
                   "LiDAR model: velodyne_vlp16 or velodyne_vlp32c")
      ->capture_default_str();
  command
      ->add_option("--frames", options->simulation.frames,
                   "Length of the run at 10 Hz (default: the scenario's own)")
      ->check(CLI::Range(1, SimulatedBerth::kMaxFrames));
  command->add_option("--seed", options->simulation.seed, "The same seed gives the same bytes")
      ->capture_default_str();
  command->add_option("--out", options->out,
                      "Write a recording folder: lidar.pcap, plc.csv, truth.csv, hull.pcd, hulltrackd.toml");
  command->add_flag("--force", options->overwrite, "Replace what is in the folder");
  command->callback([options] { run(*options); });
}

}  // namespace hulltrack
