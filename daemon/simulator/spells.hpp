// When does something happen that comes and goes? A plain schedule: rain showers, a covered window.
//
// Seconds from the first firing. Pure, nothing fails.
#pragma once

#include <cmath>
#include <limits>

namespace hulltrack {

/// From `first` on for `length`, again and again every `period`. The defaults: always.
struct Spells {
  double first = 0.0;                                       // s
  double length = std::numeric_limits<double>::infinity();  // s
  double period = std::numeric_limits<double>::infinity();  // s, more than length; infinite: only once

  [[nodiscard]] bool active(double t) const {
    if (t < first) return false;
    return std::isinf(period) ? t - first < length : std::fmod(t - first, period) < length;
  }
};

inline constexpr Spells kNever{.length = 0.0};

}  // namespace hulltrack
