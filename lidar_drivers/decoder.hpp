// What is in one datagram of a LiDAR: its points in L, each with its own firing time.
//
// Frame: L is x forward (zero azimuth), y left, z up, metres. Times are offsets to the datagram's LAST
// firing, hence never positive. A decoder keeps nothing of one data datagram for the next and checks every
// byte: bad input gives an outcome with figures, never an exception. Points are as far away as the bytes say;
// the scan builder keeps to the model's range. What a sensor says about itself in datagrams of their own goes
// through inform(). Thread rule: one caller at a time.
// Cost: a datagram of 384 returns takes a few microseconds; nothing is allocated once `out` has grown.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "core/base/time.hpp"
#include "core/geometry/scan.hpp"

namespace hulltrack {

enum class ReturnMode : std::uint8_t { unknown, strongest, last, first, dual, triple };

/// Lower-case word of a return mode, for logs.
[[nodiscard]] const char* return_mode_name(ReturnMode mode);

/// What a sensor says that its clock follows. No proof, a Livox for one says PTP before it has the time:
/// times are compared all the same (sensor_clock.hpp).
enum class ClockReference : std::uint8_t {
  unknown,  // it does not say
  none,     // its own oscillator: it is not synchronised
  ptp,
  gps,
  pulse,  // a pulse without a date
};

struct DecoderOptions {
  bool firing_correction = true;  // azimuth turned on to each laser's own firing time
  bool vertical_offset = true;    // each laser's height above the optical centre, where the maker states one
  bool repeated_echoes = false;   // dual return: also emit the second of two identical echoes
};

/// The sensor's own count of datagrams. One that stands still, as firmware that does not count leaves it, is
/// recognised (packet_sequence.hpp).
struct PacketCounter {
  std::uint64_t value;
  std::uint64_t wrap;  // it starts again at 0 after wrap - 1; > 0
};

struct DecodedPacket {
  std::vector<LidarPoint> points;  // in wire order; no point without a return; dt_ns <= 0
  Nanoseconds duration{};          // from the first to the last firing
  Nanoseconds interval{};          // from this first firing to the next datagram's, when none is lost
  Nanoseconds sensor_time{};       // the sensor's own clock at the last firing, [0, 2^62) ns, modulo
                                   // Decoder::clock_wrap(); without wrap since 1970
  std::optional<Nanoseconds>
      zero_crossing;  // when the rotor passed zero azimuth, if it did: as dt of a point
  // Of a sensor that does not rotate these are 0.
  double first_azimuth = 0.0;  // rotor, rad, [0, 2 pi), at the first firing, clockwise seen from above
  double last_azimuth = 0.0;   // the same at the last firing
  double rotation_rate = 0.0;  // rad/s, >= 0
  ReturnMode return_mode = ReturnMode::unknown;
  std::optional<PacketCounter> counter;  // where the format has one
  ClockReference clock_reference = ClockReference::unknown;
  /// Where a sector begins that the sensor leaves out: rad, last azimuth before a jump inside the datagram.
  std::optional<double> cut_azimuth;
};

enum class DecodeStatus : std::uint8_t {
  ok,
  wrong_size,         // expected, seen: bytes
  bad_flag,           // expected, seen: the block's flag
  wrong_product,      // expected, seen: product code of the datagram
  wrong_return_mode,  // seen: return mode code that this model does not have
  bad_azimuth,        // seen: an angle (or step) that a rotating sensor cannot report, in sensor units
  wrong_layout,       // expected, seen: a count, length or version in the datagram that this model has not
  awaiting_angles,  // held back: the sensor has not told its lasers' angles yet, or what it told contradicts
                    // itself (seen = kContradicted)
};

inline constexpr std::uint32_t kContradicted = 1;

struct DecodeOutcome {
  DecodeStatus status = DecodeStatus::ok;
  std::uint32_t expected = 0;
  std::uint32_t seen = 0;
  [[nodiscard]] bool ok() const { return status == DecodeStatus::ok; }
  /// Not this model's; what is held back is, but comes too early.
  [[nodiscard]] bool refused() const { return !ok() && status != DecodeStatus::awaiting_angles; }
};

class Decoder {
 public:
  Decoder() = default;
  Decoder(const Decoder&) = delete;
  Decoder& operator=(const Decoder&) = delete;
  virtual ~Decoder() = default;

  /// Replaces `out`. Unless the outcome is ok, `out` has no points and is otherwise unspecified.
  [[nodiscard]] virtual DecodeOutcome decode(std::span<const std::uint8_t> payload,
                                             DecodedPacket& out) const = 0;

  /// Takes in a datagram without points by which the sensor tells about itself: RoboSense's DIFOP, an IMU's
  /// of which nothing is made. False: it is none, or one that no unit sends; nothing has changed then. True
  /// for a unit of another model: its data are refused.
  virtual bool inform(std::span<const std::uint8_t> /*payload*/) { return false; }

  /// One clause for the log that names what was expected and what was seen.
  [[nodiscard]] virtual std::string explain(const DecodeOutcome& outcome) const = 0;

  /// The sensor's clock starts again after this long; zero = it never does.
  [[nodiscard]] virtual Nanoseconds clock_wrap() const = 0;
};

}  // namespace hulltrack
