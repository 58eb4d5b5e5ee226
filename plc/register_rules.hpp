// Do the blocks and values of [plc.read] and [plc.write] fit into the PLC's registers, each into its own?
//
// Pure, of a PlcConfig whose single values are legal.
#pragma once

#include <vector>

#include "core/base/broken_rule.hpp"
#include "plc/plc_config.hpp"

namespace hulltrack {

[[nodiscard]] std::vector<BrokenRule> check_registers(const PlcConfig& plc);

}  // namespace hulltrack
