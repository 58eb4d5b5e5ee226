#include "daemon/pipeline/joint_gate_config.hpp"

#include "core/geometry/se3.hpp"

namespace hulltrack {
namespace {

JointLimits limits_in_radians(const JointRegister& joint) {
  return {radians(joint.min), radians(joint.max), radians(joint.max_rate)};
}

}  // namespace

JointGateConfig joint_gate_config(const PlcConfig& plc) {
  const JointRegister& travel = plc.read.travel;
  return {.travel = {travel.min, travel.max, travel.max_rate},
          .slew = limits_in_radians(plc.read.slew),
          .luff = limits_in_radians(plc.read.luff),
          .poll_period = plc.poll_period,
          .has_heartbeat = plc.heartbeat_timeout > Nanoseconds{0},
          .has_command = plc.read.command >= 0};
}

}  // namespace hulltrack
