// Ouster's lidar datagram: how its profiles lay out columns and pixels.
//
// Little endian: header, C columns of {header, H pixels, footer}, footer. Nothing in a datagram tells the
// profile, H or C: the sensor's metadata does. A column is one shot of all H beams at one time.
// Source: firmware manuals 2.x and 3.x, "Lidar Data Packet Format"; ranges in mm, reflectivity 8 bit.
// Thread rule: constants.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string_view>

namespace hulltrack::ouster {

enum class Profile : std::uint8_t { legacy, rng19, rng19_dual, rng15 };

struct Layout {
  Profile profile;
  std::string_view name;  // `udp_profile_lidar` of the metadata
  std::size_t packet_header;
  std::size_t column_header;
  std::size_t pixel;
  std::size_t column_footer;
  std::size_t packet_footer;

  [[nodiscard]] constexpr std::size_t column_bytes(std::size_t pixels) const {
    return column_header + pixels * pixel + column_footer;
  }
  [[nodiscard]] constexpr std::size_t packet_bytes(std::size_t columns, std::size_t pixels) const {
    return packet_header + columns * column_bytes(pixels) + packet_footer;
  }
};

inline constexpr Layout kLayouts[] = {
    {Profile::legacy, "LEGACY", 0, 16, 12, 4, 0},
    {Profile::rng19, "RNG19_RFL8_SIG16_NIR16", 32, 12, 12, 0, 32},
    {Profile::rng19_dual, "RNG19_RFL8_SIG16_NIR16_DUAL", 32, 12, 16, 0, 32},
    {Profile::rng15, "RNG15_RFL8_NIR8", 32, 12, 4, 0, 32},
};
static_assert(kLayouts[0].packet_bytes(16, 128) == 24896);
static_assert(kLayouts[1].packet_bytes(16, 128) == 24832);
static_assert(kLayouts[2].packet_bytes(16, 32) == 8448);
static_assert(kLayouts[3].packet_bytes(16, 128) == 8448);

[[nodiscard]] constexpr const Layout& layout_of(Profile profile) {
  return kLayouts[static_cast<std::size_t>(profile)];
}

// Header of a datagram; LEGACY has none.
inline constexpr std::uint16_t kLidarPacket = 1;  // packet_type
inline constexpr std::size_t kFrameIdOffset = 2;
inline constexpr std::size_t kSerialOffset = 7;  // 40 bits

/// The IMU's datagram (udp_profile_imu LEGACY, the only one before firmware 3.2): three stamps and six
/// floats, no header (firmware manual, "IMU Data Legacy"). No lidar datagram is as small.
inline constexpr std::size_t kImuPacketBytes = 48;

// Header of a column.
inline constexpr std::size_t kMeasurementIdOffset = 8;  // after the time stamp, ns
inline constexpr std::size_t kColumnStatusOffset = 10;  // bit 0 = valid; LEGACY: in the column's footer
inline constexpr std::size_t kLegacyFrameIdOffset = 10;
inline constexpr std::uint32_t kLegacyValid = 0xFFFFFFFF;

inline constexpr std::size_t kMaxColumns = 128;         // in a datagram; 16 is usual
inline constexpr std::size_t kMaxPacketBytes = 65'507;  // what UDP carries
inline constexpr std::uint64_t kFrameIds = 65'536;      // frame_id starts again
/// m, that the widest range field of any profile (20 bits) can say.
inline constexpr double kMaxRange = 1048.575;

}  // namespace hulltrack::ouster
