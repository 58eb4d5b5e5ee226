// The section [quay] of the configuration (ICD 5) but for the map: what a site says of the quay's top.
// Plain values.
#pragma once

#include <Eigen/Core>
#include <optional>

namespace hulltrack {

struct QuayConfig {
  bool top_is_witness = true;            // false if height = "off": the top is not used
  std::optional<double> height;          // of its top at W's origin, m; empty = learn
  std::optional<Eigen::Vector2d> slope;  // of its top along X and along Y, rad; empty = learn
};

}  // namespace hulltrack
