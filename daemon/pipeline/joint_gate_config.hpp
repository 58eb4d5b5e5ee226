// The joint gate's limits as the configuration has them.
#pragma once

#include "daemon/pipeline/joint_gate.hpp"
#include "plc/plc_config.hpp"

namespace hulltrack {

/// In SI units.
[[nodiscard]] JointGateConfig joint_gate_config(const PlcConfig& plc);

}  // namespace hulltrack
