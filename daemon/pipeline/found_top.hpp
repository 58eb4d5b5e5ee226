// The quay's top that a session has found, as lines for the configuration.
#pragma once

#include <string>

#include "core/quay/quay_top.hpp"

namespace hulltrack {

/// "height = -0.150, slope = [0.00, -1.00]": what [quay] takes, m and deg.
[[nodiscard]] std::string quay_keys(const SeenTop& top);

/// One sentence for a person: the keys, and what to check before they are written down.
[[nodiscard]] std::string describe_found_top(const SeenTop& top);

}  // namespace hulltrack
