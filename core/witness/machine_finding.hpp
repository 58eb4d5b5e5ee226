// What the witnesses say of the machine in one frame: the quay, or the hull's motion with a joint.
// A plain value.
#pragma once

#include <string>

#include "core/base/status.hpp"
#include "core/witness/machine_doubt.hpp"

namespace hulltrack {

struct MachineFinding {
  Faults faults = 0;                 // plc_value while the machine is contradicted, also by earlier frames
  std::string reason;                // with figures; empty without a fault
  bool confirmed = false;            // a quay map shows in this frame that all six axes are right
  std::array<JointDoubt, 3> joints;  // by JointName: what the quay shows of each joint in this frame
};

}  // namespace hulltrack
