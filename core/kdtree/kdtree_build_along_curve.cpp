#include <vector>

#include "core/geometry/z_order.hpp"
#include "core/kdtree/kdtree_build.hpp"
#include "core/kdtree/kdtree_parts.hpp"

namespace hulltrack::kdtree {
namespace {

/// The finite points of a cloud in the order of the space-filling curve.
std::vector<Element> along_curve(std::span<const Point> cloud) {
  const std::vector<std::uint32_t> order = z_order(cloud);
  std::vector<Element> elements;
  elements.reserve(order.size());
  for (const std::uint32_t i : order) {
    const Point& p = cloud[i];
    elements.push_back({{p.x(), p.y(), p.z()}, i});
  }
  return elements;
}

/// All nodes at one height of the tree, and the box of each.
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
