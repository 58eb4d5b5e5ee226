// What stands in a PLC's holding registers, under every word order? For finding out how a site's PLC counts.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "plc/plc_config.hpp"

namespace hulltrack {

/// The word orders under which every pair of registers that is not 0 could be a joint (m or deg): a finite
/// float of 1e-4 to 1e4. Empty when all registers are 0. `registers`: whole pairs, an odd last one is left
/// out.
[[nodiscard]] std::vector<WordOrder> plausible_word_orders(std::span<const std::uint16_t> registers);

/// Reads `count` registers from `base` on and prints them with a verdict and the next step. `address`: HOST
/// or HOST:PORT, [IPv6]:PORT. Throws ToolError where the PLC does not answer.
void print_plc_table(const std::string& address, int unit_id, int base, int count);

}  // namespace hulltrack
