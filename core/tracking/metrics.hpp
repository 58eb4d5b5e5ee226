// The distance metrics of ICD 3: from map points to their nearest neighbours in the aligned scan.
#pragma once

#include <cstdint>

namespace hulltrack {

struct DistanceMetrics {
  bool valid = false;        // false: no map point could be expected in view
  double q1 = 0.0;           // 25th percentile, m
  double mean = 0.0;         // m
  double median = 0.0;       // m
  double q3 = 0.0;           // 75th percentile, m
  double rms = 0.0;          // m
  std::uint32_t points = 0;  // map points that the figures stand on
};

}  // namespace hulltrack
