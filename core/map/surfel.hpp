// A point of the map's fixed subset with what its surroundings look like.
//
// Frame H, metres. The normal's sign is arbitrary unless the surfel is `backed`. Plain values.
#pragma once

#include <cstddef>
#include <cstdint>

#include "core/geometry/cloud.hpp"

namespace hulltrack {

/// Which way a surface faces in H: within 32 deg of an axis (|n.e| > 0.85), or none of them.
enum class SurfaceClass : std::uint8_t { transverse, longitudinal, horizontal, other };  // X, Y, Z
inline constexpr std::size_t kSurfaceClasses = 3;                                        // without `other`

[[nodiscard]] constexpr const char* surface_class_name(SurfaceClass c) {
  switch (c) {
    case SurfaceClass::transverse:
      return "transverse";
    case SurfaceClass::longitudinal:
      return "longitudinal";
    case SurfaceClass::horizontal:
      return "horizontal";
    case SurfaceClass::other:
      break;
  }
  return "other";
}

struct Surfel {
  Point normal_H = Point::UnitZ();
  /// Mean of the map around the point: where the plane is, with a tenth of one map point's error.
  Point centre_H = Point::Zero();
  SurfaceClass surface = SurfaceClass::other;
  /// The map is a plane all around the point: the normal can be trusted and no edge is near.
  bool planar = false;
  /// It lies where cargo or hatch covers come and go: its absence says nothing.
  bool movable = false;
  /// Another surface lies close behind: it is seen from the side to which the normal points, or not at all.
  bool backed = false;
  static constexpr std::uint32_t kNoPatch = 0xFFFFFFFFU;
  std::uint32_t patch = kNoPatch;  // number of the patch that it belongs to (patches.hpp)
};

}  // namespace hulltrack
