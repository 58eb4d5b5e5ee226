#include "core/kdtree/kdtree_build.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "core/kdtree/kdtree_parts.hpp"

namespace hulltrack::kdtree {
namespace {

// Ranges of fewer points are split by std::nth_element: for so few a histogram does not pay.
constexpr std::size_t kSmallRange = 192;
// More bins than this no longer fit the first-level cache beside the points.
constexpr std::size_t kMaxBins = 1024;

// A range of points not yet in the tree: they are in `here`; `spare` is a buffer of the same size.
struct Range {
  std::span<Element> here;
  std::span<Element> spare;
  std::size_t leaves;

  [[nodiscard]] std::size_t size() const { return here.size(); }
};

void select_by_comparison(std::span<Element> range, std::size_t rank, std::size_t axis) {
  std::nth_element(
      range.begin(), range.begin() + static_cast<std::ptrdiff_t>(rank), range.end(),
      [axis](const Element& a, const Element& b) { return a.position[axis] < b.position[axis]; });
}

// Which of `count` equal bins of a side holds a coordinate. Rounding keeps the order: a larger coordinate
// never gets a lower bin.
struct Binning {
  float origin;
  float scale;
  std::size_t count;

  [[nodiscard]] std::size_t operator()(float coordinate) const {
    const auto bin = static_cast<std::int32_t>((coordinate - origin) * scale);
    return std::min(static_cast<std::size_t>(bin), count - 1);
  }
};

// Moves `range` to its spare buffer such that none of its first `rank` points is above one of the rest on
// `axis`.
void select_by_histogram(Range& range, std::size_t rank, std::size_t axis, const Binning& bin_of) {
  std::array<std::uint32_t, kMaxBins> histogram;
  std::fill_n(histogram.begin(), bin_of.count, 0U);
  for (const Element& e : range.here) {
    ++histogram[bin_of(e.position[axis])];
  }
  std::size_t pivot = 0;
  std::size_t below = 0;
  while (below + histogram[pivot] <= rank) {
    below += histogram[pivot++];
  }
  const std::size_t in_pivot = histogram[pivot];

  // Three write positions: below the pivot's bin, in it, above it.
  std::array<std::size_t, 3> position{0, below, below + in_pivot};
  for (const Element& e : range.here) {
    const std::size_t bin = bin_of(e.position[axis]);
    const std::size_t group = static_cast<std::size_t>(bin >= pivot) + static_cast<std::size_t>(bin > pivot);
    range.spare[position[group]++] = e;
  }
  std::swap(range.here, range.spare);
  select_by_comparison(range.here.subspan(below, in_pivot), rank - below, axis);
}

// Orders `range` such that its first `rank` points (0 < rank < size) come before the rest along the longest
// side of `bounds`.
void split_at_rank(Range& range, std::size_t rank, const Bounds& bounds) {
  const std::size_t axis = bounds.longest_axis();
  const float side = bounds.max[axis] - bounds.min[axis];
  if (!(side > 0.0F)) {
    return;  // all in one place: any order will do
  }
  const std::size_t bins = std::min(kMaxBins, range.size() / 4);
  const float scale = static_cast<float>(bins) / side;
  // If the side, or the scale of a very short side, overflows a float, there are no bins.
  if (range.size() < kSmallRange || !std::isfinite(side) || !std::isfinite(scale)) {
    select_by_comparison(range.here, rank, axis);
  } else {
    select_by_histogram(range, rank, axis, Binning{bounds.min[axis], scale, bins});
  }
}

class Builder {
 public:
  explicit Builder(std::span<const Point> cloud) : points_(cloud.size()), spare_(cloud.size()) {
    std::size_t finite = 0;
    for (std::size_t i = 0; i < cloud.size(); ++i) {
      if (cloud[i].allFinite()) {
        points_[finite++] = {{cloud[i].x(), cloud[i].y(), cloud[i].z()}, static_cast<std::uint32_t>(i)};
      }
    }
    layout_.size = finite;
  }

  Layout build() && {
    if (layout_.size == 0) {
      return std::move(layout_);
    }
    const std::size_t leaves = (layout_.size + kLeafSize - 1) / kLeafSize;
    std::size_t children_leaves = 1;  // most leaves below one child of the root
    while (children_leaves * kFanOut < leaves) {
      children_leaves *= kFanOut;
    }
    layout_.leaves.reserve(leaves);
    layout_.index.reserve(leaves * kLeafSize);
    add_nodes(1);
    build_node(0, {std::span(points_).first(layout_.size), std::span(spare_).first(layout_.size), leaves},
               children_leaves);
    return std::move(layout_);
  }

 private:
  struct Children {
    std::array<Range, kFanOut> range;
    std::array<Bounds, kFanOut> bounds;
    std::size_t count = 0;
  };

  std::uint32_t add_nodes(std::size_t count) {
    const auto first = static_cast<std::uint32_t>(layout_.nodes.size());
    layout_.nodes.resize(first + count);
    layout_.first_child.resize(first + count);
    return first;
  }

  // Fills node `node`, whose points are `range` and whose children hold at most `child_leaves` leaves.
  void build_node(std::uint32_t node, const Range& range, std::size_t child_leaves) {
    Children children;
    divide(range, (range.leaves + child_leaves - 1) / child_leaves, children);
    layout_.nodes[node] = node_of(std::span(children.bounds).first(children.count));
    if (child_leaves == 1) {
      layout_.first_child[node] = static_cast<std::uint32_t>(layout_.leaves.size()) | kLeafFlag;
      for (std::size_t lane = 0; lane < children.count; ++lane) {
        add_leaf(children.range[lane].here, layout_);
      }
      return;
    }
    const std::uint32_t first = add_nodes(children.count);
    layout_.first_child[node] = first;
    for (std::size_t lane = 0; lane < children.count; ++lane) {
      build_node(first + static_cast<std::uint32_t>(lane), children.range[lane], child_leaves / kFanOut);
    }
  }

  // Appends `parts` ranges of nearly equal size that make up `range`.
  void divide(Range range, std::size_t parts, Children& children) {
    const Bounds bounds = bounds_of(range.here);
    if (parts == 1) {
      children.range[children.count] = range;
      children.bounds[children.count++] = bounds;
      return;
    }
    const std::size_t left_parts = parts / 2;
    const std::size_t left_leaves = range.leaves * left_parts / parts;
    // Rounded up, so that neither side has more points than its leaves can hold.
    const std::size_t left_size = (range.size() * left_leaves + range.leaves - 1) / range.leaves;
    split_at_rank(range, left_size, bounds);
    divide({range.here.first(left_size), range.spare.first(left_size), left_leaves}, left_parts, children);
    divide({range.here.subspan(left_size), range.spare.subspan(left_size), range.leaves - left_leaves},
           parts - left_parts, children);
  }

  LargeArray<Element> points_;
  LargeArray<Element> spare_;
  Layout layout_;
};

}  // namespace

Layout build(std::span<const Point> cloud) { return Builder(cloud).build(); }

}  // namespace hulltrack::kdtree
