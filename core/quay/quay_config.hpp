// What a site says of the quay's top: [quay] of the configuration (ICD 5) but for the map, as plain values.
#pragma once

#include <Eigen/Core>
#include <optional>

namespace hulltrack {

struct QuayConfig {
  bool top_is_witness = true;            // false: height = "off"
  std::optional<double> height;          // of its top at W's origin, m; empty = learn
  std::optional<Eigen::Vector2d> slope;  // of its top along X and along Y, rad; empty = learn
};

}  // namespace hulltrack
