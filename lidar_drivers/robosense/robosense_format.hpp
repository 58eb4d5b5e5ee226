// RoboSense's data packet (MSOP) and the tables of the models that send it.
//
// 1248 bytes, big endian: a header of 42 (packet id, the sensor's clock at the first firing), 12 blocks of
// {flag 0xFFEE, azimuth in 0.01 deg, 32 x {distance u16, intensity u8}}, a tail of 6. Bytes 12 to 15 count
// the datagrams of a Helios (user manual, MSOP header: packets that the bottom board has sent; in the capture
// 749 steps of 749 are +1) and of a Bpearl (Nebula's decoder); in the RS16's and RS32's manuals they are
// reserved. Which lasers the 32 slots of a block are:
//   32 lasers, single return   one firing of all lasers
//   32 lasers, dual return     blocks come in pairs of one azimuth, first and second echo of one firing
//   16 lasers, single return   two firings, the second one period after the first
//   16 lasers, dual return     one firing, slots 0-15 first echo, 16-31 second echo
// Two models of a family differ in nothing that a data packet says: the unit's DIFOP packet tells them apart
// (robosense_difop.hpp). Checked on a capture: Helios 32, single return. The other models' figures are the
// maker's, without a capture to check them on; the Helios 16P's firing times are those of the maker's earlier
// driver, the current one puts its second firing 27.68 us after the first, half of the period it states. The
// unit's manual (6.2.2.3) has "~100 us" from block to block, hence some 50 us between firings, as here.
// Thread rule: constants.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string_view>

#include "core/base/time.hpp"

namespace hulltrack::robosense {

inline constexpr std::size_t kPacketBytes = 1248;  // of data and of DIFOP packets
inline constexpr std::size_t kCountOffset = 12;    // u32, ModelTable::tells_state
inline constexpr std::uint64_t kCountWrap = std::uint64_t{1} << 32;
inline constexpr std::size_t kClockOffset = 20;  // 10 bytes, see Family
inline constexpr std::size_t kHeaderBytes = 42;
inline constexpr std::size_t kBlocks = 12;
inline constexpr std::size_t kSlots = 32;  // returns in a block
inline constexpr std::size_t kSlotBytes = 3;
inline constexpr std::size_t kBlockHeaderBytes = 4;
inline constexpr std::size_t kBlockBytes = kBlockHeaderBytes + kSlots * kSlotBytes;
inline constexpr std::size_t kTailBytes = 6;
static_assert(kHeaderBytes + kBlocks * kBlockBytes + kTailBytes == kPacketBytes);

inline constexpr std::uint16_t kBlockFlag = 0xFFEE;
inline constexpr int kCentidegrees = 36000;  // one turn as the packet counts azimuth
/// Faster than any of the models turns (1200 rpm) with a margin for a motor out of control.
inline constexpr double kMaxRpm = 1500.0;

/// helios: packet id 55 AA 05 5A; clock = seconds since 1970 (6 bytes), microseconds (4 bytes).
/// classic: packet id 55 AA 05 0A 5A A5 50 A0; clock = year since 2000, month, day, hour, minute, second
/// (a byte each), milliseconds, microseconds (2 bytes each), UTC.
enum class Family : std::uint8_t { helios, classic };

inline constexpr std::uint32_t kHeliosId = 0x55AA055A;
inline constexpr std::uint32_t kClassicId = 0x55AA050A;
inline constexpr std::uint32_t kClassicIdRest = 0x5AA550A0;

struct ModelTable {
  std::string_view name;  // in the model registry
  std::string_view title;
  Family family;
  bool tells_state;  // its data packets count themselves, its DIFOP packet says what the clock follows
  std::string_view clock_by;  // as LidarModel's
  std::size_t lasers;         // 16 or 32
  bool to_zenith;             // they look up to the zenith, else to 15 deg at most
  double distance_unit;       // m
  double range;               // m
  double lens_forward;        // m, the lens ahead of the rotor's axis: turns with it
  double lens_up;             // m, the lens above L's origin
  Nanoseconds period;         // one firing of all lasers to the next
  std::array<Nanoseconds, kSlots>
      pulse;  // of each laser after its firing's first; the first `lasers` of them
};

/// All models, immutable, alive for the program's whole life.
[[nodiscard]] std::span<const ModelTable> models();
/// nullptr when there is none of that name.
[[nodiscard]] const ModelTable* find_model(std::string_view name);

}  // namespace hulltrack::robosense
