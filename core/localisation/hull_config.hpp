// What a site says of the ship: [hull] of the configuration (ICD 5) but for her map, as plain values.
#pragma once

#include <optional>

#include "core/geometry/box.hpp"
#include "core/geometry/se3.hpp"

namespace hulltrack {

struct HullConfig {
  Eigen::Vector3d reference_point = Eigen::Vector3d::Zero();    // in H, m
  std::optional<Box> region;                                    // in W; empty = no crop
  Box envelope{{-15.0F, -2.0F, -10.0F}, {15.0F, 2.0F, 10.0F}};  // displacements a berthed ship can have, m
  double max_speed = 0.3;                                       // m/s
  // Beyond these angles the pose is not the ship's, rad. A moored ship lists by 1 deg, by 3 deg when her
  // pilot is called; she trims by 1 to 3 m over her length; her lines hold her parallel to the quay.
  double max_heel = radians(4.0);
  double max_trim = radians(2.0);
  double max_yaw = radians(3.5);
};

}  // namespace hulltrack
