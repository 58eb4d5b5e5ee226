#include "daemon/simulator/ship/hull_shape.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

namespace hulltrack {
namespace {

constexpr double kBendStep = 0.002;  // m
constexpr double kFillStep = 1.0 / 40.0;

/// An edge of this extent along the ship strays by bend (extent / L)^2 from the parabola: 0.19 mm.
constexpr float kLongestPiece = 3.0F;  // m

using Triangle = std::array<Point, 3>;

float extent(const Point& a, const Point& b) { return std::abs(a.x() - b.x()); }

/// Cuts at the middle of edges, which is the same point for both triangles at an edge: no gaps open.
void cut(const Triangle& whole, std::vector<Triangle>& pieces) {
  std::vector<Triangle> open = {whole};
  while (!open.empty()) {
    const Triangle t = open.back();
    open.pop_back();
    std::size_t longest = 0;
    for (std::size_t i = 1; i < 3; ++i)
      if (extent(t[i], t[(i + 1) % 3]) > extent(t[longest], t[(longest + 1) % 3])) longest = i;
    const Point& a = t[longest];
    const Point& b = t[(longest + 1) % 3];
    const Point& c = t[(longest + 2) % 3];
    if (extent(a, b) <= kLongestPiece) {
      pieces.push_back(t);
      continue;
    }
    const Point middle = 0.5F * (a + b);
    open.push_back({a, middle, c});
    open.push_back({middle, b, c});
  }
}

}  // namespace

ShapeChange::ShapeChange(const HullShape& from, const HullShape& to, double duration)
    : from_(from),
      to_(to),
      duration_(duration),
      steps_(static_cast<std::size_t>(std::ceil(
          std::max(std::abs(to.bend - from.bend) / kBendStep, std::abs(to.fill - from.fill) / kFillStep)))) {}

std::size_t ShapeChange::at(double t) const {
  const double share = std::clamp(t / duration_, 0.0, 1.0);
  return static_cast<std::size_t>(std::lround(share * static_cast<double>(steps_)));
}

HullShape ShapeChange::shape(std::size_t index) const {
  if (index == 0) return from_;
  const double share = static_cast<double>(index) / static_cast<double>(steps_);
  return {std::lerp(from_.fill, to_.fill, share), std::lerp(from_.bend, to_.bend, share)};
}

double deflection(double bend, double ship_length, double x) {
  const double s = 2.0 * x / ship_length;
  return -bend * (1.0 - s * s);
}

double deflection_slope(double bend, double ship_length, double x) {
  return bend * 8.0 * x / (ship_length * ship_length);
}

TriangleMesh bent(const TriangleMesh& mesh, double bend, double ship_length) {
  TriangleMesh result;
  std::vector<Triangle> pieces;
  for (std::size_t i = 0; i < mesh.triangles.size(); ++i) {
    const auto& corners = mesh.triangles[i];
    pieces.clear();
    cut({mesh.vertices[corners[0]], mesh.vertices[corners[1]], mesh.vertices[corners[2]]}, pieces);
    for (const Triangle& piece : pieces) {
      const auto first = static_cast<std::uint32_t>(result.vertices.size());
      for (const Point& p : piece) {
        const double u = deflection(bend, ship_length, static_cast<double>(p.x()));
        result.vertices.push_back(p + Point(0.0F, 0.0F, static_cast<float>(u)));
      }
      result.triangles.push_back({first, first + 1, first + 2});
      result.materials.push_back(mesh.materials[i]);
    }
  }
  return result;
}

}  // namespace hulltrack
