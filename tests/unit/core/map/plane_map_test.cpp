#include "core/map/plane_map.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <random>
#include <set>

namespace hulltrack {
namespace {

const Eigen::Vector3d kHalf(5.0, 3.0, 2.0);

/// Points on a rectangle at coordinate `at` of `axis`, one a square of 7 cm, with 5 mm noise.
void add_rectangle(Cloud& cloud, int axis, double at, const Eigen::Vector3d& low, const Eigen::Vector3d& high,
                   std::mt19937& random) {
  std::normal_distribution<double> noise(0.0, 0.005);
  const int u = (axis + 1) % 3;
  const int v = (axis + 2) % 3;
  constexpr double kSpacing = 0.07;
  for (double a = low[u] + kSpacing / 2; a < high[u]; a += kSpacing) {
    for (double b = low[v] + kSpacing / 2; b < high[v]; b += kSpacing) {
      Eigen::Vector3d p;
      p[axis] = at;
      p[u] = a;
      p[v] = b;
      cloud.push_back((p + Eigen::Vector3d(noise(random), noise(random), noise(random))).cast<float>());
    }
  }
}

Cloud box() {
  std::mt19937 random(1);
  Cloud cloud;
  for (int axis = 0; axis < 3; ++axis) {
    add_rectangle(cloud, axis, -kHalf[axis], -kHalf, kHalf, random);
    add_rectangle(cloud, axis, kHalf[axis], -kHalf, kHalf, random);
  }
  return cloud;
}

/// A deck of 24 x 16 m with an open hatch of 10 x 8 m in its middle, coaming 1.4 m, floor at -6 m, and a
/// stack of covers 1.5 m high beside it, on top of the coaming's level.
Cloud deck_with_hatch() {
  std::mt19937 random(2);
  Cloud cloud;
  add_rectangle(cloud, 2, 0.0, {-12, -8, 0}, {-5, 8, 0}, random);
  add_rectangle(cloud, 2, 0.0, {5, -8, 0}, {12, 8, 0}, random);
  add_rectangle(cloud, 2, 0.0, {-5, -8, 0}, {5, -4, 0}, random);
  add_rectangle(cloud, 2, 0.0, {-5, 4, 0}, {5, 8, 0}, random);
  add_rectangle(cloud, 2, -6.0, {-5, -4, 0}, {5, 4, 0}, random);
  for (const double side : {-1.0, 1.0}) {
    add_rectangle(cloud, 0, 5.0 * side, {0, -4, -6}, {0, 4, 1.4}, random);
    add_rectangle(cloud, 1, 4.0 * side, {-5, 0, -6}, {5, 0, 1.4}, random);
  }
  add_rectangle(cloud, 2, 3.0, {5.2, -4, 0}, {7.2, 4, 0}, random);
  add_rectangle(cloud, 0, 7.2, {0, -4, 0}, {0, 4, 3.0}, random);
  return cloud;
}

PlaneMap planes_of(const Cloud& cloud) { return {cloud, KdTree(cloud), Relief(cloud)}; }

/// How far inside of the box p is, axis by axis: two small ones are an edge.
std::array<double, 3> depths(const Point& p) {
  std::array<double, 3> d{};
  for (int axis = 0; axis < 3; ++axis) {
    d[static_cast<std::size_t>(axis)] = std::abs(kHalf[axis] - std::abs(static_cast<double>(p[axis])));
  }
  std::sort(d.begin(), d.end());
  return d;
}

TEST(PlaneMap, PlanesOfABoxLieOnItsFacesAndFaceAsTheyDo) {
  const PlaneMap map = planes_of(box());
  std::array<int, 3> count{};
  for (const PlaneMap::Plane& plane : map.planes()) {
    ASSERT_NE(plane.surface, SurfaceClass::other);
    const auto axis = static_cast<std::size_t>(plane.surface);
    const auto a = static_cast<Eigen::Index>(axis);
    ++count[axis];
    // A hundred points with 5 mm each: their mean is half a millimetre off, their plane some 0.2 deg.
    // Nearer to an edge than the fit's radius, points of the other face tilt it by as much as flat allows:
    // 2.5 cm over the 15 cm that a disc of 30 cm spreads.
    const bool near_edge = depths(plane.centre_H)[1] < 0.35;
    EXPECT_NEAR(std::abs(static_cast<double>(plane.centre_H[a])), kHalf[a], near_edge ? 0.025 : 0.0025);
    EXPECT_GT(std::abs(plane.normal_H[a]), std::cos(near_edge ? 0.167F : 0.02F));
    EXPECT_NEAR(plane.normal_H.norm(), 1.0F, 1e-5F);
  }
  // One a voxel of 0.2 m; the noise makes two layers of voxels where a face lies on their boundary.
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const auto u = static_cast<Eigen::Index>((axis + 1) % 3);
    const auto v = static_cast<Eigen::Index>((axis + 2) % 3);
    const double voxels = 2.0 * (2.0 * kHalf[u] - 0.6) * (2.0 * kHalf[v] - 0.6) / 0.04;
    EXPECT_GT(count[axis], 0.9 * voxels) << axis;
  }
}

TEST(PlaneMap, EveryPointOfAFaceThatIsSeenFromAboveAndAwayFromItsEdgesHasAPlaneNearby) {
  const Cloud cloud = box();
  const PlaneMap map = planes_of(cloud);
  for (const Point& p : cloud) {
    const bool bottom = p.z() < -kHalf.z() + 0.1;  // deep below all around: as a hold's floor
    if (!bottom && depths(p)[1] > 0.4) {
      EXPECT_TRUE(map.tree().nearest(p, 0.25F)) << p.transpose();
    }
  }
}

TEST(PlaneMap, ThereIsNoneAtAnEdge) {
  const PlaneMap map = planes_of(box());
  for (const PlaneMap::Plane& plane : map.planes()) {
    EXPECT_GT(depths(plane.centre_H)[1], 0.1) << plane.centre_H.transpose();
  }
}

TEST(PlaneMap, ThereIsNoneOnAHoldsFloorNorOnCoversBesideIt) {
  const PlaneMap map = planes_of(deck_with_hatch());
  int walls = 0;
  int deck = 0;
  for (const PlaneMap::Plane& plane : map.planes()) {
    const Point& p = plane.centre_H;
    EXPECT_FALSE(p.z() < -5.5F && plane.surface == SurfaceClass::horizontal) << p.transpose();
    EXPECT_LT(p.z(), 1.6F) << p.transpose();
    walls += p.z() < -1.0F ? 1 : 0;
    deck += std::abs(p.z()) < 0.1F && plane.surface == SurfaceClass::horizontal ? 1 : 0;
  }
  EXPECT_GT(walls, 0.7 * 36.0 * 5.0 / 0.04) << "the sides of the hold stay, above its floor";
  EXPECT_GT(deck, 0.7 * (24.0 * 16.0 - 80.0) / 0.04);
}

TEST(PlaneMap, AClusterIsWhatLiesInOneCubeAndFacesOneWay) {
  const PlaneMap map = planes_of(box());
  std::map<std::uint32_t, std::array<int, 4>> of_cluster;
  std::set<std::array<int, 4>> keys;
  for (const PlaneMap::Plane& plane : map.planes()) {
    std::array<int, 4> key{};
    for (int axis = 0; axis < 3; ++axis) {
      key[static_cast<std::size_t>(axis)] =
          static_cast<int>(std::floor(plane.centre_H[axis] / PlaneMap::kClusterSize));
    }
    key[3] = static_cast<int>(plane.surface);
    keys.insert(key);
    ASSERT_LT(plane.cluster, map.clusters());
    EXPECT_EQ(of_cluster.try_emplace(plane.cluster, key).first->second, key)
        << "two cubes or ways in one cluster";
  }
  EXPECT_EQ(keys.size(), of_cluster.size()) << "one cube and way in two clusters";
  EXPECT_EQ(of_cluster.size(), map.clusters());
}

TEST(PlaneMap, ItsTreeAnswersWithNumbersOfPlanes) {
  const PlaneMap map = planes_of(box());
  ASSERT_EQ(map.tree().size(), map.planes().size());
  for (std::size_t i = 0; i < map.planes().size(); i += 37) {
    const auto nearest = map.tree().nearest(map.planes()[i].centre_H, 0.01F);
    ASSERT_TRUE(nearest);
    EXPECT_EQ(map.planes()[nearest->index].centre_H, map.planes()[i].centre_H);
  }
}

TEST(PlaneMap, AWireHasNone) {
  std::mt19937 random(3);
  std::normal_distribution<float> noise(0.0F, 0.005F);
  Cloud cloud;
  for (int i = 0; i < 500; ++i) {
    cloud.emplace_back(0.02F * static_cast<float>(i), noise(random), noise(random));
  }
  EXPECT_TRUE(planes_of(cloud).planes().empty());
}

}  // namespace
}  // namespace hulltrack
