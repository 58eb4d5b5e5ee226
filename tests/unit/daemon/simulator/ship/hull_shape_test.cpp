#include "daemon/simulator/ship/hull_shape.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "daemon/simulator/run/simulated_berth.hpp"
#include "daemon/simulator/sensing/ray_scene.hpp"
#include "daemon/simulator/ship/ship_design.hpp"
#include "daemon/simulator/ship/ship_mesh.hpp"

namespace hulltrack {
namespace {

constexpr double kLength = 120.0;

TEST(HullShape, BendIsTheDepthOfTheMiddleBelowTheEndsAndSlopeItsDerivative) {
  EXPECT_NEAR(deflection(0.2, kLength, 0.0), -0.2, 1e-15);
  EXPECT_NEAR(deflection(0.2, kLength, 60.0), 0.0, 1e-15);
  EXPECT_NEAR(deflection(0.2, kLength, -60.0), 0.0, 1e-15);
  for (const double x : {-50.0, -0.9, 33.0}) {
    constexpr double kH = 1e-4;
    const double numeric = (deflection(0.2, kLength, x + kH) - deflection(0.2, kLength, x - kH)) / (2.0 * kH);
    EXPECT_NEAR(deflection_slope(0.2, kLength, x), numeric, 1e-10);
  }
}

TEST(HullShape, AChangeGoesInStepsOfAtMostTwoMillimetresFromOneShapeToTheOther) {
  const ShapeChange change({.fill = 0.1, .bend = 0.0}, {.fill = 0.3, .bend = -0.2}, 60.0);
  EXPECT_EQ(change.at(-5.0), 0U);
  EXPECT_EQ(change.at(60.0), change.shapes() - 1);
  EXPECT_EQ(change.at(1e6), change.shapes() - 1);
  EXPECT_EQ(change.shape(0).bend, 0.0);
  EXPECT_NEAR(change.shape(change.shapes() - 1).bend, -0.2, 1e-15);
  EXPECT_NEAR(change.shape(change.shapes() - 1).fill, 0.3, 1e-15);
  for (std::size_t i = 1; i < change.shapes(); ++i)
    EXPECT_LE(change.shape(i - 1).bend - change.shape(i).bend, 0.002 + 1e-12);
  for (double t = 0.0; t <= 60.0; t += 0.37)
    EXPECT_NEAR(change.shape(change.at(t)).bend, -0.2 * t / 60.0, 0.001 + 1e-12);
  EXPECT_EQ(ShapeChange({.fill = 0.35}, {.fill = 0.35}, 10.0).shapes(), 1U);
}

TEST(HullShape, EveryPointOfABentMeshIsDisplacedByTheDeflectionAlone) {
  // Heights of the straight and of the bent ship below the same vertical rays; long faces have been cut.
  const ShipDesign ship = berth_ship();
  const RayScene straight(ship_mesh(ship));
  constexpr double kBend = 0.2;
  const RayScene sagging(bent(ship_mesh(ship), kBend, kLength));
  int compared = 0;
  for (float x = -58.0F; x < 58.0F; x += 0.73F)
    for (float y = -9.0F; y < 9.0F; y += 0.61F) {
      const auto a = straight.cast({x, y, 40.0F}, {0.0F, 0.0F, -1.0F}, 100.0F);
      const auto b = sagging.cast({x, y, 40.0F}, {0.0F, 0.0F, -1.0F}, 100.0F);
      ASSERT_EQ(a.has_value(), b.has_value()) << x << ' ' << y;
      if (!a || std::abs(a->distance - b->distance) > 0.5F) continue;  // passes an edge on either side
      ++compared;
      const double u = static_cast<double>(a->distance - b->distance);
      ASSERT_NEAR(u, deflection(kBend, kLength, static_cast<double>(x)), 3e-4) << x << ' ' << y;
    }
  EXPECT_GT(compared, 4000);
}

TEST(HullShape, TruthAtTheReferencePointIsThatOfTheBentMesh) {
  for (const char* name : {"hog", "sag"}) {
    const auto berth = std::move(SimulatedBerth::create({.scenario = name, .seed = 3})).value();
    const Nanoseconds end = std::chrono::seconds(60);
    EXPECT_NEAR(std::abs(berth->bend(end)), 0.193, 0.005) << name;
    const Eigen::Vector3d p_H = berth->hull_config().reference_point;
    // The corner of the coaming is a corner of triangles: look for it, and for the points of its edge along
    // the ship, in the mesh as it is then.
    const auto highest_near = [&](double x) {
      const TriangleMesh mesh = berth->hull_mesh_H(end);
      Eigen::Vector3d best = Eigen::Vector3d::Constant(1e9);
      const double u = deflection(berth->bend(end), kLength, x);
      for (const Point& p : mesh.vertices)
        if (const Eigen::Vector3d q = p.cast<double>();
            (q - Eigen::Vector3d(x, p_H.y(), p_H.z() + u)).norm() <
            (best - Eigen::Vector3d(x, p_H.y(), p_H.z() + u)).norm())
          best = q;
      return best;
    };
    const Eigen::Vector3d corner_H = highest_near(p_H.x());
    const ShipPose truth = berth->truth(end);
    EXPECT_NEAR((berth->T_W_H(end) * corner_H - p_H - truth.displacement).norm(), 0.0, 1e-3) << name;
    EXPECT_NEAR(std::abs((corner_H - p_H).z()), std::abs(berth->bend(end)), 2e-3) << name;
  }
}

TEST(HullShape, TruthsPitchIsTheSlopeOfTheBentShipAtTheReferencePoint) {
  const auto sag = std::move(SimulatedBerth::create({.scenario = "sag", .seed = 3})).value();
  const Nanoseconds t = std::chrono::seconds(60);
  const double x = sag->hull_config().reference_point.x();
  const auto placed = [&](double at) -> Eigen::Vector3d {
    return sag->T_W_H(t) * Eigen::Vector3d(at, 4.9, 3.3 + deflection(sag->bend(t), kLength, at));
  };
  const Eigen::Vector3d along = (placed(x + 0.01) - placed(x - 0.01)).normalized();
  const Eigen::Vector3d axis = rotation_from_rpy(sag->truth(t).rpy).col(0);
  EXPECT_NEAR((along - axis).norm(), 0.0, 1e-6);
}

}  // namespace
}  // namespace hulltrack
