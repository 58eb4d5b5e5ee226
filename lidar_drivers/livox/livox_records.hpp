// One record of a Livox datagram -> its echoes in L.
//
// Precondition: the span holds the record from `at` on. Pure; a few nanoseconds.
#pragma once

#include <array>
#include <cmath>
#include <optional>

#include "core/geometry/se3.hpp"
#include "lidar_drivers/bytes.hpp"
#include "lidar_drivers/livox/livox_format.hpp"

namespace hulltrack::livox {

struct Echo {
  double x, y, z;  // m
  double square;   // of the distance, m^2; 0 = no return
  std::uint8_t reflectivity;
  std::uint8_t tag;
};

/// As many as the kind has, in wire order.
using Echoes = std::array<Echo, 3>;

[[nodiscard]] inline Echo at_place(double x, double y, double z) {
  return {x, y, z, x * x + y * y + z * z, 0, 0};
}

[[nodiscard]] inline Echo read_cartesian(Bytes bytes, std::size_t at, bool narrow) {
  const auto s32 = [&](std::size_t i) {
    return static_cast<std::int32_t>(read_le32(bytes, at + 4 * i)) * 1e-3;
  };
  const auto s16 = [&](std::size_t i) {
    return static_cast<std::int16_t>(read_le16(bytes, at + 2 * i)) * 1e-2;
  };
  return narrow ? at_place(s16(0), s16(1), s16(2)) : at_place(s32(0), s32(1), s32(2));
}

/// Theta counts from +z, phi from +x towards +y. Both 0.01 deg.
[[nodiscard]] inline Echo at_angles(std::uint32_t depth_mm, int theta, int phi) {
  if (depth_mm == 0) return {};
  const double depth = depth_mm * 1e-3;
  const double polar = radians(theta * 0.01);
  const double around = radians(phi * 0.01);
  return at_place(depth * std::sin(polar) * std::cos(around), depth * std::sin(polar) * std::sin(around),
                  depth * std::cos(polar));
}

/// An angle that a sensor cannot report, 0.01 deg; empty where both can be.
[[nodiscard]] inline std::optional<int> bad_angle(int theta, int phi) {
  if (theta > kLargestTheta) return theta;
  if (phi > kLargestPhi) return phi;
  return std::nullopt;
}

/// False with the angle in `bad` where a spherical record has an impossible one.
[[nodiscard]] inline bool read_record(Bytes bytes, std::size_t at, const RecordKind& kind, Echoes& echoes,
                                      int& bad) {
  const bool shared = kind.spherical && kind.echoes > 1;  // the angles stand first, once
  const std::size_t angles = shared ? at : at + 4;
  int theta = 0;
  int phi = 0;
  if (kind.spherical) {
    theta = read_le16(bytes, angles);
    phi = read_le16(bytes, angles + 2);
    if (const auto angle = bad_angle(theta, phi)) {
      bad = *angle;
      return false;
    }
  }
  const std::size_t begin = shared ? at + 4 : at;
  for (std::size_t k = 0; k < kind.echoes; ++k) {
    const std::size_t echo = begin + k * kind.echo_bytes;
    const std::size_t end = echo + kind.echo_bytes;
    echoes[k] = kind.spherical ? at_angles(read_le32(bytes, echo), theta, phi)
                               : read_cartesian(bytes, echo, kind.narrow);
    echoes[k].tag = kind.tagged ? bytes[end - 1] : std::uint8_t{0};
    echoes[k].reflectivity = bytes[kind.tagged ? end - 2 : end - 1];
  }
  return true;
}

}  // namespace hulltrack::livox
