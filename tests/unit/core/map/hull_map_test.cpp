#include "core/map/hull_map.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <random>
#include <set>

#include "core/geometry/se3.hpp"
#include "core/map/surfels.hpp"

namespace hulltrack {
namespace {

const Eigen::Vector3d kHalf(8.0, 5.0, 3.0);  // of the box, m

/// The six faces of a box about the origin, one point a `spacing` square, with `noise` m in each axis.
Cloud box_cloud(double spacing, double noise, unsigned seed) {
  std::mt19937 random(seed);
  std::normal_distribution<double> normal(0.0, 1.0);
  Cloud cloud;
  for (int axis = 0; axis < 3; ++axis) {
    const int u = (axis + 1) % 3;
    const int v = (axis + 2) % 3;
    for (const double side : {-1.0, 1.0}) {
      for (double a = -kHalf[u] + spacing / 2; a < kHalf[u]; a += spacing) {
        for (double b = -kHalf[v] + spacing / 2; b < kHalf[v]; b += spacing) {
          Eigen::Vector3d p;
          p[axis] = side * kHalf[axis];
          p[u] = a;
          p[v] = b;
          p += noise * Eigen::Vector3d(normal(random), normal(random), normal(random));
          cloud.push_back(p.cast<float>());
        }
      }
    }
  }
  return cloud;
}

/// Distance of a point of a face from the face's nearest edge; `axis` is the face's.
double from_edge(const Point& p, int axis) {
  double least = 1e9;
  for (int other = 0; other < 3; ++other) {
    if (other != axis) {
      least = std::min(least, kHalf[other] - std::abs(static_cast<double>(p[other])));
    }
  }
  return least;
}

/// The face that the point lies on: the axis along which it is nearest to the surface.
int face_axis(const Point& p) {
  const Eigen::Vector3d inside = kHalf - p.cast<double>().cwiseAbs();
  Eigen::Index axis = 0;
  inside.cwiseAbs().minCoeff(&axis);
  return static_cast<int>(axis);
}

constexpr std::array kClassOfAxis{SurfaceClass::transverse, SurfaceClass::longitudinal,
                                  SurfaceClass::horizontal};

std::array<int, 3> voxel_of(const Point& p, float size) {
  const auto cell = [size](float v) { return static_cast<int>(std::floor(v / size)); };
  return {cell(p.x()), cell(p.y()), cell(p.z())};
}

/// One point of the cloud a voxel, each voxel that holds one represented.
void expect_thinned(const Cloud& thin, const Cloud& cloud, float size) {
  std::set<std::array<int, 3>> all;
  std::set<std::array<float, 3>> points;
  for (const Point& p : cloud) {
    all.insert(voxel_of(p, size));
    points.insert({p.x(), p.y(), p.z()});
  }
  std::set<std::array<int, 3>> represented;
  for (const Point& p : thin) {
    EXPECT_TRUE(points.contains({p.x(), p.y(), p.z()})) << "is no point of the map";
    represented.insert(voxel_of(p, size));
  }
  // Points on a voxel's very border may round to either side: a handful at most.
  EXPECT_NEAR(static_cast<double>(thin.size()), static_cast<double>(all.size()), 5.0);
  EXPECT_NEAR(static_cast<double>(represented.size()), static_cast<double>(thin.size()), 5.0);
}

TEST(HullMap, SubsetAndOccludersAreOneRealPointAVoxel) {
  const Cloud cloud = box_cloud(0.07, 0.004, 1);
  const HullMap map(cloud);
  EXPECT_EQ(map.cloud_H().size(), cloud.size());
  EXPECT_EQ(map.tree().size(), cloud.size());
  expect_thinned(map.subset_H(), cloud, HullMap::kSubsetVoxel);
  expect_thinned(map.occluders_H().points(), cloud, HullMap::kOccluderVoxel);
}

TEST(HullMap, SameCloudGivesTheSameSubset) {
  const HullMap one(box_cloud(0.1, 0.004, 1));
  const HullMap two(box_cloud(0.1, 0.004, 1));
  EXPECT_EQ(one.subset_H(), two.subset_H());
}

TEST(HullMap, LengthIsThatOfTheMappedHullAlongX) {
  EXPECT_NEAR(HullMap(box_cloud(0.1, 0.0, 1)).length(), 2.0 * kHalf.x(), 0.1);
  EXPECT_GT(HullMap({Point(3.0F, 4.0F, 5.0F)}).length(), 0.0) << "a map of one point is a map";
}

TEST(HullMap, PlanesLieWhereTheMapDoes) {
  const HullMap map(box_cloud(0.07, 0.004, 1));
  ASSERT_GT(map.planes().planes().size(), 1000U);
  for (const PlaneMap::Plane& plane : map.planes().planes()) {
    EXPECT_TRUE(map.tree().nearest(plane.centre_H, 0.1F)) << plane.centre_H.transpose();
  }
}

TEST(HullMap, AllOfTheMapIsOccupiedAndNothingElse) {
  const HullMap map(box_cloud(0.07, 0.004, 1));
  std::vector<OccupancyGrid::Index> cells;
  for (std::size_t i = 0; i < map.cloud_H().size(); i += 97) {
    cells.push_back(map.occupancy().cell_of(map.cloud_H()[i]));
  }
  const auto value = [&](int x, int y, int z) {
    std::array<std::uint16_t, OccupancyGrid::kHeights> sums{};
    map.occupancy().correlate(cells, x, y, sums);
    return std::size_t{sums[static_cast<std::size_t>(OccupancyGrid::kUp + z)]};
  };
  EXPECT_GT(value(0, 0, 0), 195 * cells.size() / 100);
  EXPECT_EQ(value(0, 0, 15), 0U) << "above the box, which is 6 m high";
  EXPECT_EQ(value(40, 0, 0), 0U) << "beside it";
  EXPECT_EQ(value(0, -25, 0), 0U);
}

TEST(HullMap, AShipWithoutAHatchHasNoRims) {
  const HullMap map(box_cloud(0.1, 0.004, 1));
  EXPECT_TRUE(map.rims().empty());
  EXPECT_EQ(map.probes_H(), map.subset_H());
}

/// Map densities and noise that surveys have: the surfels are the same box every time.
struct Survey {
  double spacing, noise;
};
class SurfelsOfABox : public testing::TestWithParam<Survey> {};

TEST_P(SurfelsOfABox, AreItsFacesAwayFromTheEdges) {
  const HullMap map(box_cloud(GetParam().spacing, GetParam().noise, 2));
  ASSERT_EQ(map.surfels().size(), map.subset_H().size());
  int inner = 0;
  int planar = 0;
  int at_edge = 0;
  int planar_at_edge = 0;
  for (std::size_t i = 0; i < map.surfels().size(); ++i) {
    const Point& p = map.subset_H()[i];
    const Surfel& surfel = map.surfels()[i];
    const int axis = face_axis(p);
    EXPECT_NEAR(surfel.normal_H.norm(), 1.0F, 1e-4F);
    if (const double edge = from_edge(p, axis); edge > kSurfelRadius + 0.05) {
      ++inner;
      planar += surfel.planar ? 1 : 0;
      EXPECT_GT(std::abs(surfel.normal_H[axis]), std::cos(radians(3.0))) << p.transpose();
      EXPECT_EQ(surfel.surface, kClassOfAxis[static_cast<std::size_t>(axis)]) << p.transpose();
    } else if (edge < 0.1) {
      ++at_edge;
      planar_at_edge += surfel.planar ? 1 : 0;
    }
  }
  ASSERT_GT(inner, 1000);
  EXPECT_GT(planar, 0.99 * inner) << "of " << inner;
  ASSERT_GT(at_edge, 50);
  EXPECT_EQ(planar_at_edge, 0) << "of " << at_edge;
}

INSTANTIATE_TEST_SUITE_P(Surveys, SurfelsOfABox,
                         testing::Values(Survey{0.1, 0.0}, Survey{0.05, 0.005}, Survey{0.05, 0.01},
                                         Survey{0.025, 0.005}, Survey{0.02, 0.005}),
                         [](const auto& survey) {
                           return std::to_string(static_cast<int>(1000 * survey.param.spacing + 0.5)) +
                                  "mmNoise" +
                                  std::to_string(static_cast<int>(1000 * survey.param.noise + 0.5));
                         });

/// A square of 2 m whose normal is `normal`, one point every 5 cm.
Cloud plate(const Eigen::Vector3d& normal) {
  const Eigen::Quaterniond R = Eigen::Quaterniond::FromTwoVectors(Eigen::Vector3d::UnitZ(), normal);
  Cloud cloud;
  for (int i = -20; i <= 20; ++i) {
    for (int j = -20; j <= 20; ++j) {
      cloud.push_back((R * Eigen::Vector3d(0.05 * i, 0.05 * j, 0.0)).cast<float>());
    }
  }
  return cloud;
}

Surfel middle_surfel(const Cloud& cloud) { return compute_surfels({Point::Zero()}, KdTree(cloud)).front(); }

TEST(Surfels, ClassIsTheAxisWithin32Degrees) {
  for (int axis = 0; axis < 3; ++axis) {
    const Eigen::Vector3d e = Eigen::Vector3d::Unit(axis);
    const Eigen::Vector3d aside =
        (Eigen::Vector3d::Unit((axis + 1) % 3) + Eigen::Vector3d::Unit((axis + 2) % 3)).normalized();
    for (const auto& [deg, expected] :
         std::map<double, SurfaceClass>{{0.0, kClassOfAxis[static_cast<std::size_t>(axis)]},
                                        {31.0, kClassOfAxis[static_cast<std::size_t>(axis)]},
                                        {33.0, SurfaceClass::other},
                                        {50.0, SurfaceClass::other}}) {
      const Surfel surfel = middle_surfel(plate(std::cos(radians(deg)) * e + std::sin(radians(deg)) * aside));
      EXPECT_EQ(surfel.surface, expected) << "axis " << axis << ", " << deg << " deg";
      EXPECT_TRUE(surfel.planar);
    }
  }
}

TEST(Surfels, PointOfAnEdgeAWireOrABlobIsNotPlanar) {
  const Cloud deck = plate(Eigen::Vector3d::UnitZ());
  Cloud half = deck;
  std::erase_if(half, [](const Point& p) { return p.x() > 0.01F; });
  EXPECT_FALSE(middle_surfel(half).planar) << "the rim of a deck";

  Cloud corner = half;
  for (const Point& p : plate(Eigen::Vector3d::UnitX())) {
    if (p.z() >= 0.0F) {
      corner.push_back(p);
    }
  }
  EXPECT_FALSE(middle_surfel(corner).planar) << "where deck and coaming meet";

  Cloud wire;
  for (int i = -100; i <= 100; ++i) {
    wire.emplace_back(0.01F * static_cast<float>(i), 0.0F, 0.0F);
  }
  EXPECT_FALSE(middle_surfel(wire).planar);

  std::mt19937 random(3);
  std::uniform_real_distribution<float> unit(-0.3F, 0.3F);
  Cloud blob;
  for (int i = 0; i < 150; ++i) {
    blob.emplace_back(unit(random), unit(random), unit(random));
  }
  EXPECT_FALSE(middle_surfel(blob).planar);
}

TEST(Surfels, LonelyPointHasNoSurface) {
  const Surfel surfel = middle_surfel({Point::Zero(), Point(0.1F, 0, 0), Point(0, 0.1F, 0)});
  EXPECT_FALSE(surfel.planar);
  EXPECT_EQ(surfel.surface, SurfaceClass::other);
}

}  // namespace
}  // namespace hulltrack
