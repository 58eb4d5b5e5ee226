#include "core/geometry/z_order.hpp"

#include <array>
#include <cmath>
#include <limits>

namespace hulltrack {
namespace {

constexpr std::uint32_t kAxisBits = 10;
constexpr std::uint32_t kKeyBits = 3 * kAxisBits;
constexpr std::uint32_t kDigitBits = 10;  // of the radix sort: three passes of 1024 counters
constexpr std::uint32_t kDigits = 1U << kDigitBits;

struct Keyed {
  std::uint32_t key;
  std::uint32_t index;
};

// The ten bits of v, two zeros between each (b9 0 0 b8 0 0 ...).
std::uint32_t spread_bits(std::uint32_t v) {
  v = (v | (v << 16)) & 0x030000FFU;
  v = (v | (v << 8)) & 0x0300F00FU;
  v = (v | (v << 4)) & 0x030C30C3U;
  return (v | (v << 2)) & 0x09249249U;
}

// Place of a point on the curve over a box.
class Curve {
 public:
  Curve(const Point& low, const Point& high) : origin_(low) {
    const float side = (high - low).maxCoeff();
    const float scale = static_cast<float>(1U << kAxisBits) / side;
    scale_ = std::isfinite(side) && std::isfinite(scale) ? scale : 0.0F;
  }

  [[nodiscard]] std::uint32_t operator()(const Point& p) const {
    return spread_bits(cell(p.x() - origin_.x())) | (spread_bits(cell(p.y() - origin_.y())) << 1) |
           (spread_bits(cell(p.z() - origin_.z())) << 2);
  }

 private:
  // Defined for NaN too, which comes up if the box is too large for a float: the last cell.
  [[nodiscard]] std::uint32_t cell(float offset) const {
    constexpr std::uint32_t kLast = (1U << kAxisBits) - 1;
    const float cells = offset * scale_;
    return cells < static_cast<float>(kLast) ? static_cast<std::uint32_t>(static_cast<std::int32_t>(cells))
                                             : kLast;
  }

  Point origin_;
  float scale_;
};

void sort_by_key(std::vector<Keyed>& keyed) {
  std::vector<Keyed> sorted(keyed.size());
  for (std::uint32_t shift = 0; shift < kKeyBits; shift += kDigitBits) {
    std::array<std::uint32_t, kDigits + 1> begin{};
    for (const Keyed& k : keyed) {
      ++begin[((k.key >> shift) & (kDigits - 1)) + 1];
    }
    for (std::size_t i = 1; i < begin.size(); ++i) {
      begin[i] += begin[i - 1];
    }
    for (const Keyed& k : keyed) {
      sorted[begin[(k.key >> shift) & (kDigits - 1)]++] = k;
    }
    keyed.swap(sorted);
  }
}

}  // namespace

std::vector<std::uint32_t> z_order(std::span<const Point> cloud) {
  std::vector<Keyed> keyed;
  keyed.reserve(cloud.size());
  Point low = Point::Constant(std::numeric_limits<float>::infinity());
  Point high = -low;
  for (std::uint32_t i = 0; i < cloud.size(); ++i) {
    if (cloud[i].allFinite()) {
      low = low.cwiseMin(cloud[i]);
      high = high.cwiseMax(cloud[i]);
      keyed.push_back({0, i});
    }
  }
  const Curve curve(low, high);
  for (Keyed& k : keyed) {
    k.key = curve(cloud[k.index]);
  }
  sort_by_key(keyed);
  std::vector<std::uint32_t> order;
  order.reserve(keyed.size());
  for (const Keyed& k : keyed) {
    order.push_back(k.index);
  }
  return order;
}

}  // namespace hulltrack
