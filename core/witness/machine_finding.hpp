// What the witnesses of the machine say of it in a frame. A plain value.
#pragma once

#include <string>

#include "core/base/status.hpp"
#include "core/witness/machine_doubt.hpp"

namespace hulltrack {

struct MachineFinding {
  Faults faults = 0;                 // plc_value while the machine is contradicted
  std::string reason;                // with figures; empty without a fault
  bool confirmed = false;            // a quay map confirms all six axes in this very frame
  std::array<JointDoubt, 3> joints;  // by JointName: what the quay says of them in this frame
};

}  // namespace hulltrack
