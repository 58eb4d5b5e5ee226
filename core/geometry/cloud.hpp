// A cloud of points: float triples in metres, in the frame that the variable's name says (cloud_W).
//
// Float is enough while coordinates stay within some hundred metres of their frame's origin
// (24 bits: 15 um at 128 m); sums over points are accumulated in double.
#pragma once

#include <Eigen/Core>
#include <vector>

namespace hulltrack {

using Point = Eigen::Vector3f;
using Cloud = std::vector<Point>;

}  // namespace hulltrack
