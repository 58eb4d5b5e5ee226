// What health 1 promises of a pose (ICD 3.1): no point of the hull near the chute is off by more than this.
#pragma once

#include "core/geometry/se3.hpp"

namespace hulltrack {

struct HealthContract {
  static constexpr double kPosition = 0.05;          // m, of the reference point
  static constexpr double kAttitude = radians(0.1);  // rad
};

}  // namespace hulltrack
