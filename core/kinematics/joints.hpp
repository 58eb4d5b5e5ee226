// The loader's joints: values in SI units at a time.
#pragma once

#include "core/base/time.hpp"

namespace hulltrack {

/// Gantry travel d_x (m), slew theta_r (rad), luff theta_p (rad), after sign, scale and bias.
struct Joints {
  double d_x = 0.0;
  double theta_r = 0.0;
  double theta_p = 0.0;
};

struct JointSample {
  MeasurementTime time;  // when the values were true: the PLC's latency is already subtracted
  Joints joints;
  bool on_trial = false;  // the joint gate does not believe it yet; see joint_gate.hpp
};

}  // namespace hulltrack
