#include "core/sight/metrics.hpp"

#include <cmath>

#include "core/base/percentile.hpp"

namespace hulltrack {

DistanceMetrics summarise_distances(std::vector<double>& distances) {
  DistanceMetrics metrics;
  if (distances.empty()) {
    return metrics;
  }
  double sum = 0.0;
  double squares = 0.0;
  for (const double d : distances) {
    sum += d;
    squares += d * d;
  }
  const auto n = static_cast<double>(distances.size());
  metrics.valid = true;
  metrics.points = static_cast<std::uint32_t>(distances.size());
  metrics.mean = sum / n;
  metrics.rms = std::sqrt(squares / n);
  metrics.q1 = percentile(distances, 0.25);
  metrics.median = percentile(distances, 0.5);
  metrics.q3 = percentile(distances, 0.75);
  return metrics;
}

}  // namespace hulltrack
