// Livox's point datagrams, generation 1 (Avia) and 2 (Mid-360, HAP), and the models that send them.
//
// Little endian, packed: a header, then records of one kind. A record is one laser shot: an echo, or with
// dual and triple return two or three. An echo is x, y, z (or a depth), reflectivity and, mostly, a tag.
// Source: Livox's communication protocols (SDK 1, SDK 2) and the models' user manuals; kinds and sizes of
// generation 1 agree with SDK 1's livox_def.h and the sizes that users of it state.
// A stamp type of PTP is no proof of the time: a Mid-360 in PTP mode that has not locked yet has been seen to
// stamp with the time since power-on.
// Thread rule: constants.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string_view>

#include "core/base/time.hpp"
#include "lidar_drivers/decoder.hpp"

namespace hulltrack::livox {

/// How a record is laid out.
struct RecordKind {
  std::uint8_t type;        // data type code of the header
  std::size_t bytes;        // of the record
  std::size_t echoes;       // in the record
  std::size_t echo_bytes;   // of each; spherical: without the angles where several echoes share them
  bool spherical = false;   // depth u32 mm, theta and phi u16 0.01 deg, else x, y, z
  bool narrow = false;      // Cartesian: int16 in 10 mm instead of int32 in mm
  bool tagged = true;       // the echo ends with a tag
  std::size_t records = 0;  // in every datagram; 0 = the header tells
};

struct Generation {
  std::uint8_t version;  // first byte of a datagram
  std::size_t header;    // bytes
  std::size_t type_offset;
  std::size_t stamp_type_offset;
  std::span<const ClockReference> stamp_types;  // by stamp type; a larger one is unknown
  std::size_t stamp_offset;
  std::uint8_t imu_type;  // data type of the IMU's datagrams, which have no points
  std::span<const RecordKind> kinds;
};

struct ModelTable {
  std::string_view name;  // in the model registry
  std::string_view title;
  std::string_view clock_by;  // as LidarModel's
  const Generation* generation;
  std::uint16_t port;        // of the host
  double range;              // m
  int lines;                 // lasers, fired in turn
  Nanoseconds shot_period;   // where a datagram does not tell
  bool high_noise_is_noise;  // the tag's bits 0-1 = 1: "noise with high confidence", dropped
};

extern const Generation kGeneration1;
extern const Generation kGeneration2;

// Generation 2's header.
inline constexpr std::size_t kLengthOffset = 1;    // u16, of the whole datagram
inline constexpr std::size_t kIntervalOffset = 3;  // u16, 0.1 us, first to last point
inline constexpr std::size_t kDotsOffset = 5;      // u16, records
inline constexpr std::size_t kCountOffset = 7;     // u16, one more each datagram
inline constexpr std::uint64_t kCountWrap = 65'536;
inline constexpr Nanoseconds kIntervalUnit{100};

// Generation 1's header.
inline constexpr std::uint8_t kStampIsDate = 3;  // year - 2000, month, day, hour u8, us of the hour u32 (UTC)

inline constexpr std::size_t kImuBytes =
    24;  // after the header: rotation rates and accelerations, six floats
inline constexpr int kLargestTheta = 18'000;  // 0.01 deg
inline constexpr int kLargestPhi = 36'000;

/// All models, immutable, alive for the program's whole life.
[[nodiscard]] std::span<const ModelTable> models();
/// nullptr when there is none of that name.
[[nodiscard]] const ModelTable* find_model(std::string_view name);

}  // namespace hulltrack::livox
