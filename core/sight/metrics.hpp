// The distance metrics of ICD 3: from map points to their nearest neighbours in the aligned scan.
//
// Metres. The scan is taken at full resolution, after region and exclude boxes. Pure but for the scratch that
// the caller lends. Failure: no distance gives valid = false. Cost: one search a point, three partial sorts.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

namespace hulltrack {

/// Which map points the metrics are taken over (ICD 3).
enum class MetricsScope {
  visible_subset,  // live: visible points of the fixed 0.4 m subset
  visible_full,    // every visible point
  whole_map,       // the paper's literal definition: every map point, seen or not; without q1_expected
};

struct DistanceMetrics {
  bool valid = false;        // false: no map point could be expected in view, or the scan was empty
  double q1 = 0.0;           // 25th percentile, m
  double mean = 0.0;         // m
  double median = 0.0;       // m
  double q3 = 0.0;           // 75th percentile, m
  double rms = 0.0;          // m
  std::uint32_t points = 0;  // map points that the figures are taken over
  /// What q1 should be at this pose, m (expected_distance.hpp); nothing where that cannot be told.
  std::optional<double> q1_expected = {};
  /// q1_expected is missing because fewer than ExpectedDistance::kFewest flat map points are in view within
  /// range: q1 then says nothing about the pose.
  bool few_surfels = false;
};

/// Percentiles as in core/base/percentile.hpp. `distances` (finite, m) is reordered.
[[nodiscard]] DistanceMetrics summarise_distances(std::vector<double>& distances);

}  // namespace hulltrack
