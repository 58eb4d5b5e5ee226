#include "core/registration/point_to_point_icp.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>

#include "core/registration/rigid_fit.hpp"

namespace hulltrack {
namespace {

// Part of a hold with its coamings, decks and a house, on a jittered grid: all six degrees are held.
Cloud piece_of_hull(float spacing, unsigned seed) {
  std::mt19937 rng(seed);
  std::normal_distribution<float> jitter(0.0F, 0.3F * spacing);
  Cloud cloud;
  const auto face = [&](const Point& corner, const Point& u, const Point& v) {
    for (float s = 0.0F; s < u.norm(); s += spacing) {
      for (float t = 0.0F; t < v.norm(); t += spacing) {
        cloud.push_back(corner + (s + jitter(rng)) * u.normalized() + (t + jitter(rng)) * v.normalized());
      }
    }
  };
  face({-10, -8, 0}, {20, 0, 0}, {0, 3, 0});
  face({-10, 5, 0}, {20, 0, 0}, {0, 3, 0});
  face({-8, -5, 0}, {16, 0, 0}, {0, 0, 1.5F});
  face({-8, 5, 0}, {16, 0, 0}, {0, 0, 1.5F});
  face({-8, -5, 0}, {0, 10, 0}, {0, 0, 1.5F});
  face({8, -5, 0}, {0, 10, 0}, {0, 0, 1.5F});
  face({-10, -3, 0}, {0, 6, 0}, {0, 0, 4});
  return cloud;
}

Cloud noisy_subset(const Cloud& cloud, std::size_t every, float noise, unsigned seed) {
  std::mt19937 rng(seed);
  std::normal_distribution<float> n(0.0F, noise);
  Cloud subset;
  for (std::size_t i = seed % every; i < cloud.size(); i += every) {
    subset.push_back(cloud[i] + Point(n(rng), n(rng), n(rng)));
  }
  return subset;
}

void add_clutter(Cloud& cloud, std::size_t count, unsigned seed) {
  std::mt19937 rng(seed);
  std::uniform_real_distribution<float> u(-1.0F, 1.0F);
  for (std::size_t i = 0; i < count; ++i) {
    cloud.emplace_back(40.0F * u(rng), 30.0F * u(rng), 6.0F + 3.0F * u(rng));
  }
}

Pose small_pose(double angle, double shift, unsigned seed) {
  std::mt19937 rng(seed);
  std::normal_distribution<double> n;
  Twist xi = Twist::NullaryExpr([&] { return n(rng); });
  xi.head<3>() *= angle / xi.head<3>().norm();
  xi.tail<3>() *= shift / xi.tail<3>().norm();
  return se3_exp(xi);
}

// The algorithm as it is written down: every neighbour searched among all points, every time.
IcpResult plain_icp(const Cloud& source, const Cloud& target, const Pose& T_init, const IcpConfig& config) {
  IcpResult result;
  result.T_target_source = T_init;
  const auto gate = static_cast<float>(config.max_correspondence_distance);
  while (result.iterations < config.max_iterations && !result.converged) {
    std::optional<RigidFit> fit;
    for (const Point& s : source) {
      const Eigen::Vector3d place =
          result.T_target_source.linear() * s.cast<double>() + result.T_target_source.translation();
      const Point q = place.cast<float>();
      float best = gate * gate;
      const Point* nearest = nullptr;
      for (const Point& m : target) {
        const Point d = m - q;
        const float squared = (d.x() * d.x() + d.y() * d.y()) + d.z() * d.z();
        if (squared < best) {
          best = squared;
          nearest = &m;
        }
      }
      if (nearest != nullptr) {
        if (!fit) {
          fit.emplace(nearest->cast<double>());
        }
        fit->add(place, nearest->cast<double>());
      }
    }
    ++result.iterations;
    result.matched = fit ? fit->pairs() : 0;
    const auto motion = fit ? fit->solve() : std::nullopt;
    if (!motion) {
      break;
    }
    result.T_target_source = motion->pose() * result.T_target_source;
    result.converged = motion->translation.norm() < config.translation_epsilon &&
                       rotation_angle(motion->rotation) < config.rotation_epsilon;
  }
  return result;
}

TEST(PointToPointIcp, EqualsThePlainAlgorithmBitForBit) {
  const Cloud map = piece_of_hull(0.15F, 1);
  const KdTree tree(map);
  const IcpConfig config;
  PointToPointIcp icp(config);  // one object for all: nothing is carried over
  for (unsigned seed = 1; seed <= 6; ++seed) {
    Cloud source = noisy_subset(map, 11, 0.02F, seed);
    add_clutter(source, 200, seed);
    const Pose T_init = small_pose(radians(0.1 * seed), 0.04 * seed, seed);
    const IcpResult result = icp.align(source, tree, T_init);
    const IcpResult expected = plain_icp(source, map, T_init, config);
    EXPECT_EQ(result.iterations, expected.iterations);
    EXPECT_EQ(result.matched, expected.matched);
    EXPECT_EQ(result.converged, expected.converged);
    EXPECT_EQ(result.T_target_source.matrix(), expected.T_target_source.matrix()) << "seed " << seed;
  }
}

TEST(PointToPointIcp, FindsAKnownMotionUnderNoiseAndClutter) {
  const Cloud map = piece_of_hull(0.05F, 2);
  const KdTree tree(map);
  IcpConfig config;
  config.translation_epsilon = 1e-5;
  config.rotation_epsilon = 1e-6;
  config.max_iterations = 200;
  PointToPointIcp icp(config);
  for (unsigned seed = 1; seed <= 5; ++seed) {
    const Pose T_truth = small_pose(radians(0.3), 0.15, seed);
    Cloud source;
    for (const Point& p : noisy_subset(map, 37, 0.02F, seed)) {
      source.push_back((T_truth.inverse() * p.cast<double>()).cast<float>());
    }
    add_clutter(source, source.size() / 2, seed);
    const IcpResult result = icp.align(source, tree, Pose::Identity());
    ASSERT_TRUE(result.converged) << describe(result.stop);
    const Pose error = result.T_target_source * T_truth.inverse();
    EXPECT_LT(error.translation().norm(), 0.02);
    EXPECT_LT(rotation_angle(error.linear()), radians(0.1));
    EXPECT_GT(result.rms_residual, 0.01);
    EXPECT_LT(result.rms_residual, 0.06);
    EXPECT_LE(result.mean_residual, result.rms_residual);
  }
}

TEST(PointToPointIcp, AgreesWithItselfInAnotherSourceFrame) {
  // The source frame is a name only: moving the points and the start pose together changes nothing but
  // rounding.
  const Cloud map = piece_of_hull(0.1F, 3);
  const KdTree tree(map);
  PointToPointIcp icp(IcpConfig{});
  const Cloud source = noisy_subset(map, 17, 0.02F, 3);
  const Pose T_init = small_pose(radians(0.2), 0.1, 3);
  const IcpResult here = icp.align(source, tree, T_init);
  const Pose T_there_here = small_pose(2.0, 20.0, 4);
  Cloud moved;
  for (const Point& p : source) {
    moved.push_back((T_there_here * p.cast<double>()).cast<float>());
  }
  const IcpResult there = icp.align(moved, tree, T_init * T_there_here.inverse());
  ASSERT_TRUE(here.converged && there.converged);
  EXPECT_LT((there.T_target_source * T_there_here * here.T_target_source.inverse()).translation().norm(),
            0.002);
}

TEST(PointToPointIcp, StopsAtOnceWhereItStartsRight) {
  const Cloud map = piece_of_hull(0.1F, 4);
  const KdTree tree(map);
  const IcpResult result = PointToPointIcp(IcpConfig{}).align(map, tree, Pose::Identity());
  EXPECT_TRUE(result.converged);
  EXPECT_EQ(result.iterations, 1);
  EXPECT_EQ(result.matched, map.size());
  EXPECT_EQ(result.rms_residual, 0.0);
  EXPECT_LT((result.T_target_source.matrix() - Pose::Identity().matrix()).norm(), 1e-12);
}

TEST(PointToPointIcp, StopsAtTheIterationLimit) {
  const Cloud map = piece_of_hull(0.1F, 5);
  const KdTree tree(map);
  IcpConfig config;
  config.max_iterations = 2;
  const IcpResult result = PointToPointIcp(config).align(map, tree, small_pose(radians(0.5), 0.2, 5));
  EXPECT_FALSE(result.converged);
  EXPECT_EQ(result.stop, IcpStop::iteration_limit);
  EXPECT_EQ(result.iterations, 2);
}

TEST(PointToPointIcp, SaysWhyItCannotAlign) {
  const Cloud map = piece_of_hull(0.1F, 6);
  const KdTree tree(map);
  const float nan = std::numeric_limits<float>::quiet_NaN();
  Cloud line;
  for (int i = -40; i <= 40; ++i) {
    line.emplace_back(0.1F * static_cast<float>(i), 0.0F, 0.0F);
  }
  const KdTree line_tree(line);
  PointToPointIcp icp(IcpConfig{});
  const auto expect_stop = [](const IcpResult& result, IcpStop stop) {
    EXPECT_EQ(result.stop, stop) << describe(result.stop);
    EXPECT_FALSE(result.converged);
    EXPECT_TRUE(result.T_target_source.matrix().allFinite());
    EXPECT_TRUE(result.normal_matrix.allFinite() && result.centre.allFinite());
    EXPECT_TRUE(std::isfinite(result.rms_residual) && std::isfinite(result.mean_residual));
  };
  expect_stop(icp.align(Cloud{}, tree, Pose::Identity()), IcpStop::too_few_matches);
  expect_stop(icp.align(Cloud{map[0]}, tree, Pose::Identity()), IcpStop::too_few_matches);
  expect_stop(icp.align(Cloud{map[0], map[99]}, tree, Pose::Identity()), IcpStop::too_few_matches);
  expect_stop(icp.align(Cloud(9, Point(nan, nan, nan)), tree, Pose::Identity()), IcpStop::too_few_matches);
  expect_stop(icp.align(Cloud(9, Point(500.0F, 0, 0)), tree, Pose::Identity()), IcpStop::too_few_matches);
  expect_stop(icp.align(map, KdTree(Cloud{}), Pose::Identity()), IcpStop::too_few_matches);
  expect_stop(icp.align(line, line_tree, Pose::Identity()), IcpStop::degenerate_geometry);
  expect_stop(icp.align(Cloud(9, map[0]), tree, Pose::Identity()), IcpStop::degenerate_geometry);
  Pose far = Pose::Identity();
  far.translation().x() = 1e300;
  expect_stop(icp.align(map, tree, far), IcpStop::too_few_matches);
  far.translation().x() = std::numeric_limits<double>::quiet_NaN();
  EXPECT_EQ(icp.align(map, tree, far).stop, IcpStop::invalid_start);
}

TEST(PointToPointIcp, IgnoresSourcePointsThatAreNotFinite) {
  const Cloud map = piece_of_hull(0.1F, 7);
  const KdTree tree(map);
  PointToPointIcp icp(IcpConfig{});
  const Pose T_init = small_pose(radians(0.2), 0.1, 7);
  const Cloud source = noisy_subset(map, 13, 0.02F, 7);
  Cloud dirty = source;
  for (std::size_t i = 0; i < dirty.size(); i += 10) {
    dirty.insert(
        dirty.begin() + static_cast<std::ptrdiff_t>(i),
        Point(0.0F, std::numeric_limits<float>::quiet_NaN(), std::numeric_limits<float>::infinity()));
  }
  const IcpResult result = icp.align(dirty, tree, T_init);
  EXPECT_EQ(result.T_target_source.matrix(), icp.align(source, tree, T_init).T_target_source.matrix());
}

}  // namespace
}  // namespace hulltrack
