// What are the surfaces of the simulated world made of? Triangles with a material each.
//
// Metres, in the frame that the mesh's owner says. Plain data and builders; nothing fails.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "core/geometry/cloud.hpp"
#include "core/geometry/se3.hpp"

namespace hulltrack {

enum class Material : std::uint8_t { steel, dark_steel, white_paint, concrete, ore, glass, rubber, water };

struct TriangleMesh {
  std::vector<Point> vertices;
  std::vector<std::array<std::uint32_t, 3>> triangles;
  std::vector<Material> materials;  // one a triangle

  [[nodiscard]] bool empty() const { return triangles.empty(); }
};

/// The flat or slightly warped four-cornered face a-b-c-d, corners in order around it. A face whose
/// corners coincide in pairs becomes a triangle, or nothing.
void add_quad(TriangleMesh& mesh, const Point& a, const Point& b, const Point& c, const Point& d,
              Material material);

/// All six faces of an axis-aligned box.
void add_box(TriangleMesh& mesh, const Point& min, const Point& max, Material material);

/// A closed cylinder of `sides` faces from `foot` to `head`, radius in m.
void add_cylinder(TriangleMesh& mesh, const Point& foot, const Point& head, float radius, int sides,
                  Material material);

/// A heap: a cone of `sides` faces standing on `centre`, open below.
void add_cone(TriangleMesh& mesh, const Point& centre, float radius, float height, int sides,
              Material material);

/// Adds `part`, moved by T (part -> mesh).
void append(TriangleMesh& mesh, const TriangleMesh& part, const Pose& T);

}  // namespace hulltrack
