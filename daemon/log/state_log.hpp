// What the PLC is told, in the log: one line a change of state, with the reason and the figures.
//
// The same state is announced at most once in 10 s, so that a pose on the edge of a limit does not fill
// the log; a state that outlasts that is announced late, with the number of changes in between.
// Thread rule: one owner (the plc thread). `now` is handed in.
#pragma once

#include <array>
#include <optional>
#include <string>

#include "core/base/time.hpp"
#include "daemon/log/log.hpp"
#include "plc/write_block.hpp"

namespace hulltrack {

class StateLog {
 public:
  static constexpr Nanoseconds kInterval = std::chrono::seconds(10);

  /// `sink` must outlive this object.
  explicit StateLog(LogSink& sink) : sink_(sink) {}

  /// After every block written or meant to be. `reason`: the tracker's, why health is 0; may be empty.
  void update(const WriteBlock& registers, const std::string& reason, SteadyTime now);

 private:
  void announce(const WriteBlock& registers, const std::string& reason, SteadyTime now);

  LogSink& sink_;
  std::optional<State> told_;
  SteadyTime told_since_{};
  std::optional<State> current_;
  SteadyTime current_since_{};
  unsigned unannounced_ = 0;  // changes since the last line
  std::array<std::optional<SteadyTime>, 8> last_line_{};
};

/// Which inputs or checks the fault bits name, in words: "PLC data stale, a LiDAR silent"; "" for none.
[[nodiscard]] std::string fault_words(Faults faults);

}  // namespace hulltrack
