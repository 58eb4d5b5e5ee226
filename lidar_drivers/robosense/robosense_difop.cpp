#include "lidar_drivers/robosense/robosense_difop.hpp"

#include <algorithm>
#include <cmath>
#include <optional>
#include <string>

namespace hulltrack::robosense {

namespace {

constexpr int kMaxAngle = 9000;        // 0.01 deg
constexpr double kZenithModel = 50.0;  // deg, about half way between 15 and 90

using Angles = std::array<LaserAngles, kSlots>;

ReturnMode return_mode_of(Family family, std::uint8_t code) {
  if (code == 0) return ReturnMode::dual;
  if (family == Family::helios) {
    if (code == 4) return ReturnMode::strongest;
    if (code == 5) return ReturnMode::last;
    if (code == 6) return ReturnMode::first;
  } else {
    if (code == 1) return ReturnMode::strongest;
    if (code == 2) return ReturnMode::last;
  }
  return ReturnMode::unknown;
}

ClockReference clock_reference_of(std::uint8_t state) {
  constexpr ClockReference kStates[] = {ClockReference::none, ClockReference::gps, ClockReference::ptp};
  return state < std::size(kStates) ? kStates[state] : ClockReference::unknown;
}

/// 0.01 deg; none where it is not calibrated or out of range.
std::optional<int> signed_angle(Bytes payload, std::size_t at) {
  const std::uint8_t sign = payload[at];
  const int size = read_be16(payload, at + 1);
  if (sign > 1 || size > kMaxAngle) return std::nullopt;
  return sign == 0 ? size : -size;
}

bool differs_from_all_before(const Angles& angles, std::size_t k) {
  for (std::size_t j = 0; j < k; ++j) {
    if (angles[j].elevation_deg == angles[k].elevation_deg) return false;
  }
  return true;
}

/// How many lasers the common table has; 0: neither 16 nor 32.
std::size_t read_common_table(Bytes payload, Angles& angles) {
  std::array<std::size_t, 2> real{};  // in either half
  for (std::size_t k = 0; k < kSlots; ++k) {
    const auto vertical = signed_angle(payload, kDifopVerticalOffset + k * kAngleBytes);
    const auto horizontal = signed_angle(payload, kDifopHorizontalOffset + k * kAngleBytes);
    angles[k] = {std::nan(""), 0.0};
    if (!vertical || !horizontal) continue;
    angles[k] = {*vertical * 0.01, *horizontal * 0.01};
    if (differs_from_all_before(angles, k)) ++real[k / 16];
  }
  if (real[0] != 16) return 0;
  if (real[1] == 16) return 32;
  return real[1] <= 1 ? 16 : 0;  // one: the value that the rest is filled with
}

bool read_rs16_table(Bytes payload, Angles& angles) {
  for (std::size_t k = 0; k < 16; ++k) {
    const std::size_t at = kDifopRs16VerticalOffset + k * kAngleBytes;
    const int size = payload[at] << 16 | read_be16(payload, at + 1);
    if (size > kMaxAngle * 100) return false;
    angles[k] = {(k < 8 ? -size : size) * 1e-4, 0.0};
    if (!differs_from_all_before(angles, k)) return false;
  }
  return true;
}

std::size_t read_angles(Bytes payload, const ModelTable& model, Angles& angles) {
  const bool classic = model.family == Family::classic;
  if (classic && model.lasers == 16 && read_rs16_table(payload, angles)) return 16;
  const std::size_t lasers = read_common_table(payload, angles);
  if (!classic || lasers == 32) return lasers;
  return read_rs16_table(payload, angles) ? 16 : 0;
}

}  // namespace

bool is_difop(Bytes payload) {
  return payload.size() == kPacketBytes && std::ranges::equal(payload.first(kDifopId.size()), kDifopId);
}

Result<Difop> read_difop(Bytes payload, const ModelTable& model) {
  if (payload.size() != kPacketBytes) {
    return Error{"has " + std::to_string(payload.size()) + " bytes; a DIFOP packet has " +
                 std::to_string(kPacketBytes)};
  }
  if (!is_difop(payload)) return Error{"is not a DIFOP packet: those begin with A5 FF 00 5A 11 11 55 55"};
  Difop difop{};
  difop.lasers = read_angles(payload, model, difop.angles);
  if (difop.lasers == 0) {
    return Error{
        "is a DIFOP packet without the angles of 16 or 32 lasers: allowed are elevations that all "
        "differ and angles within 90 deg"};
  }
  for (std::size_t k = 0; k < difop.lasers; ++k)
    difop.to_zenith = difop.to_zenith || difop.angles[k].elevation_deg > kZenithModel;
  const std::uint16_t rpm = read_be16(payload, kDifopRpmOffset);
  difop.rpm = rpm <= kMaxRpm ? rpm : 0.0;
  difop.mode_code = payload[kDifopReturnModeOffset];
  difop.mode = return_mode_of(model.family, difop.mode_code);
  difop.clock_reference =
      model.tells_state ? clock_reference_of(payload[kDifopClockOffset]) : ClockReference::unknown;
  return difop;
}

bool fits(const Difop& unit, const ModelTable& model) {
  return unit.lasers == model.lasers && unit.to_zenith == model.to_zenith;
}

}  // namespace hulltrack::robosense
