#include "daemon/simulator/sensing/mesh.hpp"

#include <cmath>
#include <numbers>

namespace hulltrack {
namespace {

std::uint32_t add_vertex(TriangleMesh& mesh, const Point& p) {
  mesh.vertices.push_back(p);
  return static_cast<std::uint32_t>(mesh.vertices.size() - 1);
}

void add_triangle(TriangleMesh& mesh, const Point& a, const Point& b, const Point& c, Material material) {
  constexpr float kSmallestArea = 1e-6F;  // m2
  if ((b - a).cross(c - a).norm() < 2.0F * kSmallestArea) return;
  const std::uint32_t i = add_vertex(mesh, a);
  const std::uint32_t j = add_vertex(mesh, b);
  const std::uint32_t k = add_vertex(mesh, c);
  mesh.triangles.push_back({i, j, k});
  mesh.materials.push_back(material);
}

float angle_of_side(int side, int sides) {
  return 2.0F * std::numbers::pi_v<float> * static_cast<float>(side) / static_cast<float>(sides);
}

}  // namespace

void add_quad(TriangleMesh& mesh, const Point& a, const Point& b, const Point& c, const Point& d,
              Material material) {
  add_triangle(mesh, a, b, c, material);
  add_triangle(mesh, a, c, d, material);
}

void add_box(TriangleMesh& mesh, const Point& min, const Point& max, Material material) {
  const auto corner = [&](int i) {
    return Point((i & 1) != 0 ? max.x() : min.x(), (i & 2) != 0 ? max.y() : min.y(),
                 (i & 4) != 0 ? max.z() : min.z());
  };
  constexpr int kFaces[6][4] = {{0, 2, 3, 1}, {4, 5, 7, 6}, {0, 1, 5, 4},
                                {2, 6, 7, 3}, {0, 4, 6, 2}, {1, 3, 7, 5}};
  for (const auto& face : kFaces)
    add_quad(mesh, corner(face[0]), corner(face[1]), corner(face[2]), corner(face[3]), material);
}

void add_cylinder(TriangleMesh& mesh, const Point& foot, const Point& head, float radius, int sides,
                  Material material) {
  const Point axis = (head - foot).normalized();
  const Point u = axis.unitOrthogonal();
  const Point v = axis.cross(u);
  const auto rim = [&](int side) -> Point {
    const float angle = angle_of_side(side, sides);
    return radius * (std::cos(angle) * u + std::sin(angle) * v);
  };
  for (int side = 0; side < sides; ++side) {
    const Point a = rim(side);
    const Point b = rim(side + 1);
    add_quad(mesh, foot + a, foot + b, head + b, head + a, material);
    add_triangle(mesh, foot, foot + b, foot + a, material);
    add_triangle(mesh, head, head + a, head + b, material);
  }
}

void add_cone(TriangleMesh& mesh, const Point& centre, float radius, float height, int sides,
              Material material) {
  const Point top = centre + Point(0.0F, 0.0F, height);
  for (int side = 0; side < sides; ++side) {
    const float a = angle_of_side(side, sides);
    const float b = angle_of_side(side + 1, sides);
    add_triangle(mesh, centre + radius * Point(std::cos(a), std::sin(a), 0.0F),
                 centre + radius * Point(std::cos(b), std::sin(b), 0.0F), top, material);
  }
}

void append(TriangleMesh& mesh, const TriangleMesh& part, const Pose& T) {
  const auto offset = static_cast<std::uint32_t>(mesh.vertices.size());
  for (const Point& p : part.vertices) mesh.vertices.push_back((T * p.cast<double>()).cast<float>());
  for (const auto& t : part.triangles)
    mesh.triangles.push_back({t[0] + offset, t[1] + offset, t[2] + offset});
  mesh.materials.insert(mesh.materials.end(), part.materials.begin(), part.materials.end());
}

}  // namespace hulltrack
