#include "daemon/service/reader_process.hpp"

#include <fcntl.h>
#include <poll.h>
#include <spawn.h>
#include <sys/syscall.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <csignal>
#include <cstring>
#include <system_error>
#include <vector>

#include "core/base/text.hpp"
#include "daemon/service/reader.hpp"

namespace hulltrack {
namespace {

/// A process that was killed is gone by then, unless the kernel cannot end it: a device does not answer.
constexpr std::chrono::milliseconds kTimeToDie{100};

[[noreturn]] void fail(int error, const char* what) {
  throw std::system_error(error, std::generic_category(), what);
}

/// The child's descriptors while it is made: out of the way of the numbers that it expects.
class Inherited {
 public:
  explicit Inherited(int fd) : fd_(fcntl(fd, F_DUPFD_CLOEXEC, kReaderStepsFd + 1)) {
    if (fd_ < 0) {
      fail(errno, "cannot pass on a descriptor");
    }
  }
  ~Inherited() { close(fd_); }
  Inherited(const Inherited&) = delete;
  Inherited& operator=(const Inherited&) = delete;
  [[nodiscard]] int fd() const { return fd_; }

 private:
  int fd_;
};

struct SpawnPlan {
  SpawnPlan() {
    posix_spawn_file_actions_init(&actions);
    posix_spawnattr_init(&attributes);
    sigset_t none;
    sigset_t all;
    sigemptyset(&none);
    sigfillset(&all);
    posix_spawnattr_setsigmask(&attributes, &none);
    posix_spawnattr_setsigdefault(&attributes, &all);
    posix_spawnattr_setflags(&attributes, POSIX_SPAWN_SETSIGMASK | POSIX_SPAWN_SETSIGDEF);
  }
  ~SpawnPlan() {
    posix_spawn_file_actions_destroy(&actions);
    posix_spawnattr_destroy(&attributes);
  }
  SpawnPlan(const SpawnPlan&) = delete;
  SpawnPlan& operator=(const SpawnPlan&) = delete;
  posix_spawn_file_actions_t actions;
  posix_spawnattr_t attributes;
};

}  // namespace

ReaderProcess::ReaderProcess(const ReaderSetup& setup, const std::filesystem::path& config_file,
                             SteadyTime now)
    : setup_(setup), deadline_(now + setup.wall) {
  while (waitpid(-1, nullptr, WNOHANG) > 0) {  // readers that took longer to die than anybody waited
  }
  int ends[2];
  if (pipe2(ends, O_CLOEXEC | O_NONBLOCK) != 0) {
    fail(errno, "cannot make a pipe");
  }
  steps_ = ends[0];
  try {
    start(ends[1], config_file);
  } catch (...) {
    close(ends[0]);
    close(ends[1]);
    throw;
  }
  close(ends[1]);
}

void ReaderProcess::start(int steps_write_end, const std::filesystem::path& config_file) {
  const Inherited configuration(configuration_.fd());
  const Inherited files(files_.fd());
  const Inherited steps(steps_write_end);
  SpawnPlan plan;
  posix_spawn_file_actions_addopen(&plan.actions, STDIN_FILENO, "/dev/null", O_RDONLY, 0);
  posix_spawn_file_actions_addopen(&plan.actions, STDOUT_FILENO, "/dev/null", O_WRONLY, 0);
  posix_spawn_file_actions_adddup2(&plan.actions, configuration.fd(), kReaderConfigurationFd);
  posix_spawn_file_actions_adddup2(&plan.actions, files.fd(), kReaderFilesFd);
  posix_spawn_file_actions_adddup2(&plan.actions, steps.fd(), kReaderStepsFd);
  posix_spawn_file_actions_addclosefrom_np(&plan.actions, kReaderStepsFd + 1);
  std::vector<std::string> words{"hulltrackd",
                                 std::string(kReaderFlag),
                                 std::to_string(getpid()),
                                 std::to_string(setup_.memory_mb),
                                 std::to_string(setup_.cpu.count()),
                                 setup_.low_priority ? "low" : "own",
                                 config_file.string()};
  std::vector<char*> arguments;
  for (std::string& word : words) {
    arguments.push_back(word.data());
  }
  arguments.push_back(nullptr);
  const int error =
      posix_spawn(&pid_, setup_.program.c_str(), &plan.actions, &plan.attributes, arguments.data(), environ);
  if (error != 0) {
    fail(error, "cannot start the process that reads the files");
  }
  pidfd_ = static_cast<int>(syscall(SYS_pidfd_open, pid_, 0));  // the C library's header is for C alone
}

ReaderProcess::~ReaderProcess() {
  if (!ended_) {
    kill(pid_, SIGKILL);
    pollfd entry{pidfd_, POLLIN, 0};
    poll(&entry, 1, static_cast<int>(kTimeToDie.count()));
    waitpid(pid_, nullptr, WNOHANG);
  }
  if (steps_ >= 0) {
    close(steps_);
  }
  if (pidfd_ >= 0) {
    close(pidfd_);
  }
}

void ReaderProcess::step(SteadyTime now) {
  if (ended_) {
    return;
  }
  if (steps_ >= 0) {
    note_steps();
  }
  note_end(now);
  if (!ended_ && !too_late_ && now >= deadline_) {
    too_late_ = true;
    kill(pid_, SIGKILL);
  }
}

void ReaderProcess::note_steps() {
  ReaderStep message;
  ssize_t got = 0;
  while ((got = read(steps_, &message, sizeof message)) == static_cast<ssize_t>(sizeof message)) {
    if (message.step > static_cast<std::uint8_t>(PreparationStep::done)) {
      continue;
    }
    at_ = static_cast<PreparationStep>(message.step);
    lidar_ = message.lidar;
    configuration_read_ = configuration_read_ || at_ == PreparationStep::configuration_read;
  }
  if (got >= 0 || (errno != EAGAIN && errno != EINTR)) {
    close(steps_);
    steps_ = -1;
  }
}

void ReaderProcess::note_end(SteadyTime now) {
  int status = 0;
  if (waitpid(pid_, &status, WNOHANG) == pid_) {
    ended_ = true;
    if (steps_ >= 0) {
      note_steps();  // what it has written last
    }
    if (status != 0 || at_ != PreparationStep::done) {
      failure_ = words_of_end(status);
    }
  } else if (too_late_ && now >= deadline_ + kTimeToDie) {
    ended_ = true;  // for all that can be done about it
    failure_ = words_of_end(status);
  }
}

std::string ReaderProcess::words_of_end(int status) {
  if (too_late_) {
    return format_text(
        "was not done after %lld s and was given up: does the device answer on which it lies? If it is only "
        "large, thin it out",
        static_cast<long long>(setup_.wall.count()));
  }
  if (!WIFSIGNALED(status)) {
    return format_text("ended the reader with exit code %d; its own line on standard error says why",
                       WEXITSTATUS(status));
  }
  const int number = WTERMSIG(status);
  if (number == SIGXCPU) {
    return format_text("took more than %lld s of processor time; it is damaged or too large: thin it out",
                       static_cast<long long>(setup_.cpu.count()));
  }
  if (number == SIGKILL) {
    was_killed_ = true;
    return "was ended by SIGKILL, as the kernel does when memory runs out: is another program taking it, is "
           "MemoryMax= of the unit too low?";
  }
  const char* const name = sigabbrev_np(number);
  return format_text("ended the reader with signal %s (%s); it is damaged: copy it again or make it again",
                     name != nullptr ? name : std::to_string(number).c_str(), strsignal(number));
}

}  // namespace hulltrack
