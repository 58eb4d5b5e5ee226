// How often has the service failed in a row, and how long does it wait before it tries again?
//
// The service manager restarts it 0.1 s after every end that nobody asked for, for ever. What fails at once
// each time would fill the log and keep the computer busy, so from the fourth failure in a row on the service
// itself waits, with the PLC informed (plc_stand_in.hpp). The count lives in a file that outlasts a restart
// and nothing else. Thread rule: the main thread. Failure: a file that cannot be read or written counts as no
// failure: without a memory there is no pause.
#pragma once

#include <filesystem>
#include <optional>
#include <string>

#include "core/base/time.hpp"

namespace hulltrack {

/// A line a minute in the log is enough, and a cause that is gone is noticed within a minute.
inline constexpr Nanoseconds kLongestPause = std::chrono::minutes(1);
/// After this long at work a failure is the first again. No less than the longest pause: whoever fails again
/// and again has been at work for half of the time.
inline constexpr Nanoseconds kGoodSpell = kLongestPause;

/// After so many failures in a row: none up to 3, then a second, doubling.
[[nodiscard]] Nanoseconds restart_pause(int failures);

class RestartRecord {
 public:
  /// `folder`: RuntimeDirectory= of the unit; none for a service that was started by hand.
  explicit RestartRecord(std::optional<std::filesystem::path> folder) : folder_(std::move(folder)) {}

  struct Verdict {
    int failures = 0;      // in a row, until now
    std::string last_end;  // in the service manager's words; empty if it left none
    Nanoseconds pause{0};
  };
  /// At the start, once: counts this start as a failure until one of the others is called.
  Verdict begin();
  /// It has been at work for kGoodSpell.
  void forget();
  /// It ends as somebody asked.
  void end();

 private:
  void keep(int failures) const;

  std::optional<std::filesystem::path> folder_;
};

}  // namespace hulltrack
