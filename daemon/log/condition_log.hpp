// A standing condition in the log: one line when it begins, one when it ends, no storm when it flaps.
//
// An episode that begins within 10 s of the last entry line is held back; if it is still there when the
// 10 s are over it is told then, and the entry line counts what was held back. An exit line is written
// for every entry line, so the log's last word is always true (within 10 s).
// Thread rule: one owner. `now` is handed in. Cost: nothing while nothing changes.
#pragma once

#include <concepts>
#include <optional>
#include <string>

#include "core/base/text.hpp"
#include "core/base/time.hpp"
#include "daemon/log/log.hpp"

namespace hulltrack {

class ConditionLog {
 public:
  static constexpr Nanoseconds kInterval = std::chrono::seconds(10);

  /// `sink` must outlive this object. Entry lines get `level`, exit lines notice.
  explicit ConditionLog(LogSink& sink, LogLevel level = LogLevel::warning) : sink_(sink), level_(level) {}

  /// Call it regularly, also while nothing changes. `entry()` and `exit(lasted)` give the lines and are
  /// called only when one is written.
  template <std::invocable Entry, std::invocable<Nanoseconds> Exit>
  void update(bool active, SteadyTime now, Entry&& entry, Exit&& exit) {
    if (active && !active_) {
      ++episodes_;
      began_ = now;
    }
    active_ = active;
    if (active_ && !told_ && (!entry_line_ || now - *entry_line_ >= kInterval)) {
      sink_.write(level_, entry() + held_back());
      told_ = true;
      entry_line_ = now;
      episodes_ = 0;
    } else if (!active_ && told_) {
      sink_.write(LogLevel::notice, exit(now - began_));
      told_ = false;
    }
  }

  [[nodiscard]] bool active() const { return active_; }

 private:
  [[nodiscard]] std::string held_back() const {
    return episodes_ > 1 ? " (and " + counted(episodes_ - 1, "more time") + " since the last such line)"
                         : std::string{};
  }

  LogSink& sink_;
  LogLevel level_;
  bool active_ = false;
  bool told_ = false;  // the log's last word is the entry line
  SteadyTime began_{};
  std::optional<SteadyTime> entry_line_;
  unsigned episodes_ = 0;  // begun since the last entry line
};

/// Turns a counter into a condition: active while it has grown within the last two seconds.
class RecentGrowth {
 public:
  static constexpr Nanoseconds kMemory = std::chrono::seconds(2);

  [[nodiscard]] bool update(std::uint64_t counter, SteadyTime now) {
    if (counter > counter_) {
      counter_ = counter;
      grew_ = now;
    }
    return grew_ && now - *grew_ < kMemory;
  }

 private:
  std::uint64_t counter_ = 0;
  std::optional<SteadyTime> grew_;
};

}  // namespace hulltrack
