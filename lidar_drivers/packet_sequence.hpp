// Where does a datagram stand among its neighbours: next, missing some, late, or seen before?
//
// Works on the sensor's own clock, which is exact to a microsecond where receive stamps jitter, and needs it
// only to run evenly: a clock that is wrong, or starts again, is followed. What is missing the sensor's count
// of datagrams tells where it has one that moves, else the time between two of them. Sectors that the sensor
// itself leaves out are not taken for losses. Thread rule: one caller. Cost: one hash of the bytes.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>

#include "core/base/time.hpp"
#include "lidar_drivers/decoder.hpp"

namespace hulltrack {

class PacketSequence {
 public:
  enum class Place {
    first,         // nothing to compare with
    next,          // newer than all before
    duplicate,     // byte for byte one of the last 32
    out_of_order,  // older than the newest by `behind`
    restart,       // sensor and host disagree about the time since the newest: new beginning
  };
  struct Step {
    Place place = Place::first;
    std::uint32_t lost = 0;  // datagrams missing before this one (place next)
    Nanoseconds behind{};    // last firing before the newest one's (place out_of_order)
  };

  /// `clock_wrap` as Decoder::clock_wrap().
  explicit PacketSequence(Nanoseconds clock_wrap) : clock_wrap_(clock_wrap) {}

  [[nodiscard]] Step note(std::span<const std::uint8_t> bytes, const DecodedPacket& packet,
                          MeasurementTime received);

 private:
  [[nodiscard]] bool seen_before(std::span<const std::uint8_t> bytes);
  [[nodiscard]] std::uint32_t lost_between(const DecodedPacket& packet, Nanoseconds elapsed) const;

  Nanoseconds clock_wrap_;
  std::array<std::size_t, 32> hashes_{};
  std::size_t hash_count_ = 0;
  bool started_ = false;
  Nanoseconds newest_sensor_time_{};
  Nanoseconds newest_duration_{};
  Nanoseconds newest_interval_{};
  MeasurementTime newest_received_{};
  double newest_azimuth_ = 0.0;  // rad, at the last firing
  std::optional<double> cut_azimuth_;
  std::optional<PacketCounter> newest_counter_;
};

}  // namespace hulltrack
