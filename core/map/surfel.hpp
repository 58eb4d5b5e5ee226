// The surface around one map point: where it is, which way it faces, and what else is known of it.
//
// Each point of the metric subset (hull_map.hpp) has a surfel, also where the map is not flat (`planar` is
// false). Frame H, metres. Plain values.
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
  /// Unit; sign arbitrary unless `backed`.
  Point normal_H = Point::UnitZ();
  /// Mean of the map points around it: a point of the plane, with a tenth of one map point's error.
  Point centre_H = Point::Zero();
  SurfaceClass surface = SurfaceClass::other;
  /// The map is flat all around the point: the normal can be trusted and no edge is near.
  bool planar = false;
  /// It lies where cargo or hatch covers come and go. A scan that does not show it says nothing.
  bool movable = false;
  /// Another surface lies close behind. It can be seen only from the side to which the normal points.
  bool backed = false;
  static constexpr std::uint32_t kNoLandmark = 0xFFFFFFFFU;
  std::uint32_t landmark = kNoLandmark;  // number of the landmark that it belongs to (landmarks.hpp)
};

}  // namespace hulltrack
