// How high is the quay's top at a place of the berth? A sloping plane as quays have, uneven as they are.
//
// From the quay's edge it falls to a gutter 28 m inland; behind that the yard rises again. Along the quay it
// has settled a little. Unevenness is a few centimetres over 9 to 37 m. W, metres. Pure, nothing fails.
#pragma once

#include "daemon/simulator/sensing/mesh.hpp"

namespace hulltrack {

inline constexpr float kQuayHalfLength = 160.0F;  // along x
inline constexpr float kQuayDepth = 90.0F;        // from the edge inland
inline constexpr float kGutter = -28.0F;          // y where the fall ends

/// The plane of the top between edge and gutter: z = kQuayHeight + kQuaySlopeX * x + kQuaySlopeY * y.
inline constexpr float kQuayHeight = -0.15F;
inline constexpr float kQuaySlopeX = 0.0005F;
inline constexpr float kQuaySlopeY = 0.01F;  // drains away from the edge, towards negative y

/// Height of the top, unevenness included; y <= 0.
[[nodiscard]] float quay_top(float x, float y);

/// Top and front of the quay.
void add_quay_ground(TriangleMesh& mesh);

}  // namespace hulltrack
