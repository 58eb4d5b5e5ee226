// What the witnesses of the machine say of it in a frame. A plain value.
#pragma once

#include <string>

#include "core/base/status.hpp"
#include "core/integrity/machine_doubt.hpp"

namespace hulltrack {

struct MachineFinding {
  Faults faults = 0;       // plc_value while the machine is contradicted
  std::string reason;      // with figures; empty without a fault
  bool confirmed = false;  // a quay map confirms all six axes in this very frame
  /// By JointName: what the quay says of them in this frame. `hidden` is infinite also where a small error
  /// would be seen and a large one would not be found.
  std::array<JointDoubt, 3> joints;
};

}  // namespace hulltrack
