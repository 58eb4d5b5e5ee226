#include "daemon/simulator/sensing/ray_scene.hpp"

#include <gtest/gtest.h>

#include <numbers>

#include "daemon/simulator/random.hpp"

namespace hulltrack {
namespace {

TriangleMesh unit_box() {
  TriangleMesh mesh;
  add_box(mesh, {-1.0F, -1.0F, -1.0F}, {1.0F, 1.0F, 1.0F}, Material::concrete);
  return mesh;
}

TEST(RayScene, DistancesToABoxEqualTheSlabMethod) {
  const RayScene scene(unit_box());
  RandomStream random(1, 1);
  int hits = 0;
  for (int i = 0; i < 20000; ++i) {
    const auto draw = [&](double low, double high) { return static_cast<float>(random.uniform(low, high)); };
    const Point origin(draw(-6, -2), draw(-6, 6), draw(-6, 6));
    const Point target(draw(-1.5, 1.5), draw(-1.5, 1.5), draw(-1.5, 1.5));
    const Point direction = (target - origin).normalized();
    double enter = 0.0;
    double leave = 1e9;
    for (int axis = 0; axis < 3; ++axis) {
      const double d = static_cast<double>(direction[axis]);
      const double a = (-1.0 - static_cast<double>(origin[axis])) / d;
      const double b = (1.0 - static_cast<double>(origin[axis])) / d;
      enter = std::max(enter, std::min(a, b));
      leave = std::min(leave, std::max(a, b));
    }
    const auto hit = scene.cast(origin, direction, 100.0F);
    if (std::abs(leave - enter) < 1e-4) continue;  // grazes an edge: either answer is right
    ASSERT_EQ(hit.has_value(), enter < leave);
    ASSERT_EQ(scene.blocked(origin, direction, 100.0F), enter < leave);
    if (!hit) continue;
    ++hits;
    EXPECT_NEAR(static_cast<double>(hit->distance), enter, 1e-4);
    EXPECT_EQ(hit->material, Material::concrete);
  }
  EXPECT_GT(hits, 5000);
}

TEST(RayScene, IncidenceIsTheAngleToTheSurfaceNormal) {
  const RayScene scene(unit_box());
  for (const double angle : {0.0, 0.3, 0.7}) {
    const Point direction(static_cast<float>(std::cos(angle)), static_cast<float>(std::sin(angle)), 0.0F);
    const auto hit = scene.cast(Point(-1.0F, 0.0F, 0.0F) - 0.5F * direction, direction, 10.0F);
    ASSERT_TRUE(hit);
    EXPECT_NEAR(static_cast<double>(hit->cos_incidence), std::cos(angle), 1e-5);
  }
}

TEST(RayScene, NothingBeyondTheMaximalDistance) {
  const RayScene scene(unit_box());
  EXPECT_FALSE(scene.cast({-4.0F, 0.0F, 0.0F}, {1.0F, 0.0F, 0.0F}, 2.9F));
  EXPECT_TRUE(scene.cast({-4.0F, 0.0F, 0.0F}, {1.0F, 0.0F, 0.0F}, 3.1F));
}

TEST(Mesh, CylinderPointsLieOnItsSurface) {
  TriangleMesh mesh;
  add_cylinder(mesh, {1.0F, 2.0F, 0.0F}, {1.0F, 2.0F, 5.0F}, 0.5F, 16, Material::steel);
  const RayScene scene(mesh);
  const auto hit = scene.cast({-9.0F, 2.0F, 2.5F}, {1.0F, 0.0F, 0.0F}, 100.0F);
  ASSERT_TRUE(hit);
  EXPECT_NEAR(hit->distance, 9.5F, 0.5F * (1.0F - std::cos(std::numbers::pi_v<float> / 16.0F)) + 1e-4F);
}

TEST(Mesh, AppendMovesThePart) {
  TriangleMesh part;
  add_quad(part, {0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}, Material::steel);
  TriangleMesh whole;
  append(whole, part, pose_from_xyz_rpy_deg({10.0, 0.0, 3.0}, {0.0, 0.0, 90.0}));
  const RayScene scene(whole);
  const auto hit = scene.cast({9.5F, 0.5F, 10.0F}, {0.0F, 0.0F, -1.0F}, 20.0F);
  ASSERT_TRUE(hit);
  EXPECT_NEAR(hit->distance, 7.0F, 1e-5F);
  EXPECT_FALSE(scene.cast({10.5F, 0.5F, 10.0F}, {0.0F, 0.0F, -1.0F}, 20.0F));
}

}  // namespace
}  // namespace hulltrack
