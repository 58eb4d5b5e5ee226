// A log sink in front of a slow one: write() never waits, a thread of its own does.
//
// syslog(3) blocks while the journal is stopped and its socket full, a terminal while its output is
// paused; neither may hold up the loop. Lines queue up to a bound; beyond it the newest are dropped and
// counted, and one line reports the count as soon as there is room again.
// Thread rule: write() from any thread. The slow writer runs on the log's own thread only.
#pragma once

#include <cstddef>
#include <functional>
#include <memory>
#include <string_view>
#include <thread>

#include "core/base/time.hpp"
#include "daemon/log/log.hpp"

namespace hulltrack {

class QueuedLog final : public LogSink {
 public:
  /// May block and must not throw.
  using SlowWriter = std::function<void(LogLevel, std::string_view)>;

  /// `patience`: how long the destructor waits for lines still queued; then they are given up.
  explicit QueuedLog(SlowWriter writer, std::size_t capacity = 512,
                     Nanoseconds patience = std::chrono::milliseconds(500));
  ~QueuedLog() override;

  /// Cost: one short lock and one copy of the line.
  void write(LogLevel level, std::string_view line) override;
  /// Waits until the lines queued so far are written, as long as the destructor would.
  void flush();
  /// Lines dropped since the start.
  [[nodiscard]] std::size_t dropped() const;

 private:
  struct Shared;
  static void drain(const std::shared_ptr<Shared>& shared);

  std::shared_ptr<Shared> shared_;  // the thread's too: it may outlive this object, stuck in a system call
  Nanoseconds patience_;
  std::thread thread_;
};

}  // namespace hulltrack
