// Percentiles of a few thousand figures: distances, errors, times.
//
// Interpolated linearly between order statistics, rank p (n - 1) counted from 0, as numpy does by default.
// Pure; any thread. Cost: one partial sort.
#pragma once

#include <span>

namespace hulltrack {

/// The value below which the share p (0 .. 1) of `values` lies; 0 if there are none. `values` (finite) is
/// reordered.
[[nodiscard]] double percentile(std::span<double> values, double p);

}  // namespace hulltrack
