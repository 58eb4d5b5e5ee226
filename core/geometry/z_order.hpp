// In which order do points lie along a curve that keeps neighbours together?
//
// The Z-order curve (Morton 1966) through 1024^3 equal cubes over the cloud's box. Any frame and unit; the
// same cloud always has the same order. No failure: points that are not finite are left out, and if the box
// is too large for a float, the order is some order. Pure. Cost: three passes of a radix sort, some 10 ns a
// point.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "core/geometry/cloud.hpp"

namespace hulltrack {

/// Indices of the finite points of `cloud`, in the order of the curve.
[[nodiscard]] std::vector<std::uint32_t> z_order(std::span<const Point> cloud);

}  // namespace hulltrack
