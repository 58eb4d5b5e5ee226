#include "core/base/percentile.hpp"

#include <algorithm>
#include <cstddef>

namespace hulltrack {

double percentile(std::span<double> values, double p) {
  if (values.empty()) {
    return 0.0;
  }
  const double rank = p * static_cast<double>(values.size() - 1);
  const auto k = static_cast<std::size_t>(rank);
  const auto at_k = values.begin() + static_cast<std::ptrdiff_t>(k);
  std::nth_element(values.begin(), at_k, values.end());
  const double low = *at_k;
  if (k + 1 == values.size()) {
    return low;
  }
  const double high = *std::min_element(at_k + 1, values.end());
  return low + (rank - static_cast<double>(k)) * (high - low);
}

}  // namespace hulltrack
