// How a scan is aligned with the map: [tracking] of the configuration (ICD 5) as plain values.
#pragma once

#include "core/geometry/se3.hpp"

namespace hulltrack {

enum class RegistrationMethod {
  automatic,       // the best method of this version
  point_to_point,  // the method of the paper (Guo 2025, 2.3)
};

/// Defaults: the paper's parameters (Guo 2025, 2.3).
struct RegistrationConfig {
  double voxel_size = 0.5;                   // m
  double max_correspondence_distance = 0.3;  // m
  int max_iterations = 50;
  double translation_epsilon = 0.001;      // m
  double rotation_epsilon = radians(0.1);  // rad
  RegistrationMethod method = RegistrationMethod::automatic;
};

}  // namespace hulltrack
