#include <cmath>
#include <vector>

#include "core/search/kdtree_build.hpp"
#include "core/search/kdtree_parts.hpp"

namespace hulltrack::kdtree {
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

// Place of a point on the Z-order curve (Morton 1966) through 1024^3 equal cubes over the cloud's box.
class Curve {
 public:
  explicit Curve(const Bounds& box) {
    const std::size_t axis = box.longest_axis();
    const float side = box.max[axis] - box.min[axis];
    const float scale = static_cast<float>(1U << kAxisBits) / side;
    origin_ = {box.min[0], box.min[1], box.min[2]};
    scale_ = std::isfinite(side) && std::isfinite(scale) ? scale : 0.0F;  // no order: any will do
  }

  [[nodiscard]] std::uint32_t operator()(const Point& p) const {
    return spread_bits(cell(p.x() - origin_[0])) | (spread_bits(cell(p.y() - origin_[1])) << 1) |
           (spread_bits(cell(p.z() - origin_[2])) << 2);
  }

 private:
  // Also for what is no number, where the box is too large to be measured.
  [[nodiscard]] std::uint32_t cell(float offset) const {
    constexpr std::uint32_t kLast = (1U << kAxisBits) - 1;
    const float cells = offset * scale_;
    return cells < static_cast<float>(kLast) ? static_cast<std::uint32_t>(static_cast<std::int32_t>(cells))
                                             : kLast;
  }

  std::array<float, 3> origin_;
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

/// The finite points of a cloud in the order of the curve.
std::vector<Element> along_curve(std::span<const Point> cloud) {
  std::vector<Keyed> keyed;
  keyed.reserve(cloud.size());
  Point low = Point::Constant(kInfinity);
  Point high = Point::Constant(-kInfinity);
  for (std::uint32_t i = 0; i < cloud.size(); ++i) {
    if (cloud[i].allFinite()) {
      low = low.cwiseMin(cloud[i]);
      high = high.cwiseMax(cloud[i]);
      keyed.push_back({0, i});
    }
  }
  const Curve curve(Bounds{{low.x(), low.y(), low.z(), 0.0F}, {high.x(), high.y(), high.z(), 0.0F}});
  for (Keyed& k : keyed) {
    k.key = curve(cloud[k.index]);
  }
  sort_by_key(keyed);
  std::vector<Element> elements;
  elements.reserve(keyed.size());
  for (const Keyed& k : keyed) {
    const Point& p = cloud[k.index];
    elements.push_back({{p.x(), p.y(), p.z()}, k.index});
  }
  return elements;
}

/// What stands at one height of the tree: its nodes and the box of each.
struct Level {
  std::vector<Node> nodes;
  std::vector<Bounds> boxes;
};

/// One node over every kFanOut boxes.
Level level_above(std::span<const Bounds> boxes) {
  Level level;
  for (std::size_t first = 0; first < boxes.size(); first += kFanOut) {
    const auto children = boxes.subspan(first, std::min(kFanOut, boxes.size() - first));
    level.nodes.push_back(node_of(children));
    Bounds& box = level.boxes.emplace_back();
    for (const Bounds& child : children) {
      box.add(child);
    }
  }
  return level;
}

}  // namespace

Layout build_along_curve(std::span<const Point> cloud) {
  const std::vector<Element> elements = along_curve(cloud);
  Layout layout;
  layout.size = elements.size();
  if (elements.empty()) {
    return layout;
  }
  const std::size_t leaves = (elements.size() + kLeafSize - 1) / kLeafSize;
  layout.leaves.reserve(leaves);
  layout.index.reserve(leaves * kLeafSize);
  std::vector<Bounds> boxes;
  boxes.reserve(leaves);
  for (std::size_t first = 0; first < elements.size(); first += kLeafSize) {
    const auto points = std::span(elements).subspan(first, std::min(kLeafSize, elements.size() - first));
    add_leaf(points, layout);
    boxes.push_back(bounds_of(points));
  }
  std::vector<Level> levels{level_above(boxes)};
  while (levels.back().nodes.size() > 1) {
    levels.push_back(level_above(levels.back().boxes));
  }
  // From the root down; the children of a level's nodes are the next level, in order.
  for (std::size_t height = levels.size(); height-- > 0;) {
    const std::vector<Node>& nodes = levels[height].nodes;
    const std::size_t below = height == 0 ? 0 : layout.nodes.size() + nodes.size();
    for (std::size_t i = 0; i < nodes.size(); ++i) {
      const auto first_child = static_cast<std::uint32_t>(below + i * kFanOut);
      layout.nodes.push_back(nodes[i]);
      layout.first_child.push_back(height == 0 ? first_child | kLeafFlag : first_child);
    }
  }
  return layout;
}

}  // namespace hulltrack::kdtree
