// Two sensors send to one port and nobody said which is meant: whose datagrams are taken?
//
// Of a LiDAR without `source`. The first whose datagram can be decoded, and nobody else's: two are never
// mixed.
//   A second one beside a first that had been alone for 2 s changes nothing; every sensor that runs sends
// several datagrams in that time. No other is taken later, not even when the first is silent: which of them
// is the spare one nobody can say.
//   Where the second comes earlier it is open which of the two is meant (a service that starts with both
// there): the first one's are taken, so that there is something to look at, but disputed() says that no pose
// may be steered by. The dispute ends when one of the two has been alone for 2 s.
//   A first that never had company and is silent for the LiDAR's timeout_ms makes room for the next: a spare
// sensor with another address. Receive stamps only. No failure. Thread rule: one owner. Cost: constant.
#pragma once

#include <cstdint>
#include <optional>

#include "core/base/time.hpp"

namespace hulltrack {

class SenderLock {
 public:
  /// For so long a sensor has to be alone.
  static constexpr Nanoseconds kAlone = std::chrono::seconds(2);

  explicit SenderLock(Nanoseconds timeout) : timeout_(timeout) {}

  /// Whether a datagram from `ip` is taken. Judges it against what came before.
  [[nodiscard]] bool takes(std::uint32_t ip, MeasurementTime received);

  /// A datagram from `ip`, which had been taken, is one of this LiDAR's model.
  void decoded(std::uint32_t ip, MeasurementTime received);

  /// Another sensor's datagrams dropped so far.
  [[nodiscard]] std::uint64_t dropped() const { return dropped_; }
  /// The two, in host byte order; meaningful while dropped() > 0.
  [[nodiscard]] std::uint32_t first() const { return first_.value_or(0); }
  [[nodiscard]] std::uint32_t second() const { return second_.value_or(0); }
  /// Nobody can say which of the two is meant.
  [[nodiscard]] bool disputed() const { return second_ && !alone_; }

 private:
  Nanoseconds timeout_;
  std::optional<std::uint32_t> first_, second_;
  MeasurementTime since_{};        // first's first datagram, or second's last one
  MeasurementTime first_heard_{};  // decoded
  bool alone_ = false;             // the first had been alone for kAlone before it had company
  std::uint64_t dropped_ = 0;
};

}  // namespace hulltrack
