#include "lidar_drivers/packet_sequence.hpp"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <functional>
#include <numbers>
#include <string_view>

namespace hulltrack {

namespace {

/// Further back than this is no reordering on the way but a clock that was set.
constexpr Nanoseconds kMaxReordering = std::chrono::milliseconds(10);
/// By how much the host's and the sensor's idea of the time between two datagrams may differ.
constexpr Nanoseconds kMaxDisagreement = std::chrono::milliseconds(200);
/// Longer than this is silence, which is reported as such, not as a loss of datagrams.
constexpr Nanoseconds kLongestLoss = std::chrono::milliseconds(500);
/// Within this of the sector's edge a gap between datagrams is the sector.
constexpr double kCutTolerance = 0.03;  // rad

/// a - b on a clock that starts again after `wrap`, as the difference of smallest size.
Nanoseconds difference(Nanoseconds a, Nanoseconds b, Nanoseconds wrap) {
  Nanoseconds d = a - b;
  if (wrap == Nanoseconds::zero()) return d;
  if (d > wrap / 2) d -= wrap;
  if (d < -wrap / 2) d += wrap;
  return d;
}

}  // namespace

PacketSequence::Step PacketSequence::note(std::span<const std::uint8_t> bytes, const DecodedPacket& packet,
                                          MeasurementTime received) {
  Step step;
  if (seen_before(bytes)) {
    step.place = Place::duplicate;
    return step;
  }
  if (started_) {
    const Nanoseconds elapsed = difference(packet.sensor_time, newest_sensor_time_, clock_wrap_);
    const Nanoseconds host_elapsed = received - newest_received_;
    if (elapsed < Nanoseconds::zero() && elapsed > -kMaxReordering) {
      step.place = Place::out_of_order;
      step.behind = -elapsed;
      return step;
    }
    const bool agree = std::chrono::abs(elapsed - host_elapsed) <= kMaxDisagreement;
    step.place = agree ? Place::next : Place::restart;
    if (agree) step.lost = lost_between(packet, elapsed);
  }
  started_ = true;
  newest_sensor_time_ = packet.sensor_time;
  newest_duration_ = packet.duration;
  newest_interval_ = packet.interval;
  newest_received_ = received;
  newest_azimuth_ = packet.last_azimuth;
  newest_counter_ = packet.counter;
  if (packet.cut_azimuth) cut_azimuth_ = packet.cut_azimuth;
  return step;
}

bool PacketSequence::seen_before(std::span<const std::uint8_t> bytes) {
  const std::string_view text(reinterpret_cast<const char*>(bytes.data()), bytes.size());
  const std::size_t hash = std::hash<std::string_view>{}(text);
  const auto known = std::min(hash_count_, hashes_.size());
  if (std::find(hashes_.begin(), hashes_.begin() + static_cast<std::ptrdiff_t>(known), hash) !=
      hashes_.begin() + static_cast<std::ptrdiff_t>(known)) {
    return true;
  }
  hashes_[hash_count_++ % hashes_.size()] = hash;
  return false;
}

std::uint32_t PacketSequence::lost_between(const DecodedPacket& packet, Nanoseconds elapsed) const {
  const Nanoseconds first_to_first = elapsed - packet.duration + newest_duration_;
  if (packet.interval <= Nanoseconds::zero() || first_to_first > kLongestLoss) return 0;
  const bool counted = packet.counter && newest_counter_ && packet.counter->value != newest_counter_->value;
  if (counted) {
    const std::uint64_t wrap = packet.counter->wrap;
    const std::uint64_t steps = (packet.counter->value + wrap - newest_counter_->value % wrap) % wrap;
    // No more than the time has room for: a counter may begin again.
    const auto most = static_cast<std::uint64_t>(first_to_first / packet.interval + 1);
    return static_cast<std::uint32_t>(std::min(steps == 0 ? 0 : steps - 1, most));
  }
  if (cut_azimuth_) {
    const double off = std::abs(std::remainder(newest_azimuth_ - *cut_azimuth_, 2.0 * std::numbers::pi));
    if (off < kCutTolerance) return 0;
  }
  const auto missing = std::llround(static_cast<double>((first_to_first - newest_interval_).count()) /
                                    static_cast<double>(packet.interval.count()));
  return static_cast<std::uint32_t>(std::max<long long>(missing, 0));
}

}  // namespace hulltrack
