#include "core/tracking/metrics.hpp"

#include <algorithm>
#include <cmath>

namespace hulltrack {
namespace {

/// `values` from `from` on hold everything not below what precedes them.
double percentile(std::vector<double>& values, double p, std::size_t from) {
  const double rank = p * static_cast<double>(values.size() - 1);
  const auto k = static_cast<std::size_t>(rank);
  const auto offset = [](std::size_t i) { return static_cast<std::ptrdiff_t>(i); };
  std::nth_element(values.begin() + offset(from), values.begin() + offset(k), values.end());
  const double low = values[k];
  if (k + 1 == values.size()) {
    return low;
  }
  const double high = *std::min_element(values.begin() + offset(k + 1), values.end());
  return low + (rank - static_cast<double>(k)) * (high - low);
}

}  // namespace

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
  metrics.q1 = percentile(distances, 0.25, 0);
  metrics.median = percentile(distances, 0.5, static_cast<std::size_t>(0.25 * (n - 1.0)));
  metrics.q3 = percentile(distances, 0.75, static_cast<std::size_t>(0.5 * (n - 1.0)));
  return metrics;
}

}  // namespace hulltrack
