// A rule between configuration keys that is broken: what each value alone does not show to be wrong.
//
// A plain value.
#pragma once

#include <string>
#include <vector>

namespace hulltrack {

struct BrokenRule {
  std::vector<std::string> keys;  // concerned, the one to blame first: "plc.read.slew.offset", "lidar.1.port"
  std::string message;            // what is wrong; what is allowed
};

}  // namespace hulltrack
