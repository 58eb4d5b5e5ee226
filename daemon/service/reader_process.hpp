// The service's hold on the reader (reader.hpp): starts it, follows it, ends it, says how it ended.
//
// The reader is bounded so that a reload cannot harm the session at work: its memory and that of the service
// together stay below MemoryMax= of the unit, and however it ends, nothing but this object knows of it.
// Never waits, but for a tenth of a second when it has to end the reader. Thread rule: one thread, which must
// live as long as the reader: the kernel ends the reader with the thread that started it.
// Failure: the constructor throws std::system_error when no process can be started.
#pragma once

#include <sys/types.h>

#include <chrono>
#include <filesystem>
#include <optional>
#include <string>

#include "core/base/time.hpp"
#include "daemon/service/memory_file.hpp"
#include "daemon/service/prepare.hpp"

namespace hulltrack {

struct ReaderSetup {
  std::filesystem::path program = "/proc/self/exe";  // that answers to kReaderFlag
  /// At a reload there are at once the map in force (less than the reader needed to make it, M), the points
  /// that the reader hands over (12 of the 60 bytes that it needs a point, M / 5) and either the reader or
  /// the same work done again in the service (M): 2.2 M, and 64 MB of all else, in 2048 MB.
  std::size_t memory_mb = 900;
  /// Seven times what a map that fills the memory takes (14 million points, 6 to 9 s).
  std::chrono::seconds cpu{60};
  /// Three times that: it may run at the lowest priority, and a disk may be slow.
  std::chrono::seconds wall{180};
  /// Behind the session at work.
  bool low_priority = false;
};

class ReaderProcess {
 public:
  ReaderProcess(const ReaderSetup& setup, const std::filesystem::path& config_file, SteadyTime now);
  /// Ends the reader if it has not ended.
  ~ReaderProcess();
  ReaderProcess(const ReaderProcess&) = delete;
  ReaderProcess& operator=(const ReaderProcess&) = delete;

  /// Readable when step() has something to note: for poll(2).
  [[nodiscard]] int fd() const { return steps_ >= 0 ? steps_ : pidfd_; }
  /// Notes what the reader has done and whether it has ended or has to be.
  void step(SteadyTime now);

  /// Where it is, or where it was when it ended.
  [[nodiscard]] PreparationStep at() const { return at_; }
  [[nodiscard]] std::size_t lidar() const { return lidar_; }
  /// The configuration's bytes are there.
  [[nodiscard]] bool configuration_read() const { return configuration_read_; }
  [[nodiscard]] bool ended() const { return ended_; }
  /// Once it has ended without having done its work: a clause that says how and what to do.
  [[nodiscard]] const std::optional<std::string>& failure() const { return failure_; }
  /// Once it has failed: ended from outside, so that another try may succeed with the same files.
  [[nodiscard]] bool was_killed() const { return was_killed_; }

  [[nodiscard]] MemoryFile& configuration() { return configuration_; }
  [[nodiscard]] MemoryFile& files() { return files_; }

 private:
  void start(int steps_write_end, const std::filesystem::path& config_file);
  void note_steps();
  void note_end(SteadyTime now);
  [[nodiscard]] std::string words_of_end(int status);

  ReaderSetup setup_;
  SteadyTime deadline_;
  MemoryFile configuration_{"configuration"};
  MemoryFile files_{"files"};
  int steps_ = -1;  // the pipe's reading end; closed when the reader has closed its own
  pid_t pid_ = -1;
  int pidfd_ = -1;
  PreparationStep at_ = PreparationStep::configuration;
  std::size_t lidar_ = 0;
  bool configuration_read_ = false;
  bool too_late_ = false;
  bool ended_ = false;
  bool was_killed_ = false;
  std::optional<std::string> failure_;
};

}  // namespace hulltrack
