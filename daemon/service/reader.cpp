#include "daemon/service/reader.hpp"

#include <sys/prctl.h>
#include <sys/resource.h>
#include <unistd.h>

#include <algorithm>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <fstream>
#include <stdexcept>
#include <string>

#include "daemon/service/memory_file.hpp"
#include "daemon/service/prepare.hpp"
#include "lidar_drivers/model_registry.hpp"

// The memory that a sanitizer reserves for itself is more than any limit.
#if defined(__has_feature)
#if __has_feature(address_sanitizer) || __has_feature(thread_sanitizer)
#define HULLTRACK_RESERVES_MEMORY
#endif
#endif
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
#define HULLTRACK_RESERVES_MEMORY
#endif

namespace hulltrack {
namespace {

/// The unit runs the service at -10: where both want the processor the service gets 99 % of it (nice(1) is a
/// factor of 1.25 a step). The lowest, 19, would wait for ever beside any other busy program.
constexpr int kLowPriority = 10;

/// Never above what somebody else has set.
void limit(__rlimit_resource what, rlim_t soft, rlim_t hard) {
  rlimit limits{};
  getrlimit(what, &limits);
  limits = {.rlim_cur = std::min(soft, limits.rlim_max), .rlim_max = std::min(hard, limits.rlim_max)};
  if (setrlimit(what, &limits) != 0) {
    throw std::runtime_error("cannot set a limit of its own");
  }
}

/// As a child of `parent`, which may have died meanwhile.
void die_with(pid_t parent) {
  prctl(PR_SET_PDEATHSIG, SIGKILL);
  if (getppid() != parent) {
    std::exit(EXIT_FAILURE);
  }
}

void bound_itself(rlim_t memory_mb, rlim_t cpu_s) {
  prctl(PR_SET_NAME, "hulltrackd-read");
  std::ofstream("/proc/self/oom_score_adj") << 1000;
  // 1, not 0: a handler of core files behind a pipe is left out as well.
  limit(RLIMIT_CORE, 1, 1);
  limit(RLIMIT_CPU, cpu_s, cpu_s + 1);
#ifdef HULLTRACK_RESERVES_MEMORY
  static_cast<void>(memory_mb);
#else
  limit(RLIMIT_DATA, memory_mb << 20U, memory_mb << 20U);
#endif
}

void tell(PreparationStep step, std::size_t lidar) {
  const ReaderStep message{static_cast<std::uint8_t>(step), static_cast<std::uint8_t>(lidar)};
  write_all(kReaderStepsFd, {reinterpret_cast<const char*>(&message), sizeof message});
}

PreparedFiles read_all(const std::string& config_file, std::size_t memory_mb, bool low_priority) {
  const Result<std::string> text = read_config_text(config_file);
  if (!text) {
    return {.problems = {{config_file, 0, text.error().message}}};
  }
  const ConfigReading reading = parse_config(*text, config_file, lidar_models());
  write_all(kReaderConfigurationFd, *text);
  tell(PreparationStep::configuration_read, 0);
  // All else may take long. This lowers the priority of reading from disk as well.
  if (low_priority) {
    setpriority(PRIO_PROCESS, 0, kLowPriority);
  }
  return read_prepared_files(config_file, reading, memory_mb, tell);
}

}  // namespace

int run_reader(int count, const char* const* arguments) {
  if (count != 6) {
    std::fprintf(stderr, "hulltrackd: %s is for the service itself\n", kReaderFlag.data());
    return EXIT_FAILURE;
  }
  try {
    die_with(std::stoi(arguments[1]));
    const unsigned long memory_mb = std::stoul(arguments[2]);
    bound_itself(memory_mb, std::stoul(arguments[3]));
    write_prepared_files(kReaderFilesFd,
                         read_all(arguments[5], memory_mb, std::string_view(arguments[4]) == "low"));
    tell(PreparationStep::done, 0);
    return EXIT_SUCCESS;
  } catch (const std::exception& error) {
    std::fprintf(stderr, "hulltrackd: reading the files: %s\n", error.what());
    return EXIT_FAILURE;
  }
}

}  // namespace hulltrack
