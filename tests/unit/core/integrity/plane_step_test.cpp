#include <gtest/gtest.h>

#include <random>

#include "core/integrity/integrity.hpp"

namespace hulltrack {
namespace {

/// Surfels on the six faces of a 20 x 12 x 2 m box about `centre`.
std::vector<SurfelObservation> box_surfels(const Eigen::Vector3d& centre, int per_face,
                                           std::mt19937& random) {
  std::uniform_real_distribution<double> unit(-1.0, 1.0);
  const Eigen::Vector3d half(10.0, 6.0, 1.0);
  std::vector<SurfelObservation> surfels;
  for (int axis = 0; axis < 3; ++axis) {
    for (const double side : {-1.0, 1.0}) {
      for (int i = 0; i < per_face; ++i) {
        Eigen::Vector3d p = half.cwiseProduct(Eigen::Vector3d(unit(random), unit(random), unit(random)));
        p[axis] = side * half[axis];
        surfels.push_back({centre + p, side * Eigen::Vector3d::Unit(axis), 0.0});
      }
    }
  }
  return surfels;
}

/// What rays see of planes that really sit at `T` times where they are expected: the plane through T p
/// with normal R n, measured along n from p.
void displace(std::vector<SurfelObservation>& surfels, const Pose& T) {
  for (SurfelObservation& s : surfels) {
    s.offset = s.n_W.dot(T * s.p_W - s.p_W);
  }
}

TEST(PlaneStep, FindsASmallDisplacementOfTheReferencePoint) {
  std::mt19937 random(1);
  const Eigen::Vector3d centre(40.0, -20.0, 8.0);
  const Eigen::Vector3d reference(70.0, -22.0, 9.0);  // 30 m lever arm
  for (int trial = 0; trial < 20; ++trial) {
    auto surfels = box_surfels(centre, 100, random);
    std::uniform_real_distribution<double> unit(-1.0, 1.0);
    Pose T = Pose::Identity();
    const Eigen::Vector3d w = 0.003 * Eigen::Vector3d(unit(random), unit(random), unit(random));
    T.linear() = so3_exp(w);
    T.translation() =
        centre - T.linear() * centre + 0.08 * Eigen::Vector3d(unit(random), unit(random), unit(random));
    displace(surfels, T);
    const PlaneStep step = solve_plane_step(surfels, reference);
    ASSERT_TRUE(step.solved);
    EXPECT_LT((step.translation - (T * reference - reference)).norm(), 1e-3);
    EXPECT_LT((step.rotation - w).norm(), 2e-5);
  }
}

TEST(PlaneStep, OutliersDoNotPullIt) {
  std::mt19937 random(2);
  auto surfels = box_surfels({0, 0, 0}, 100, random);
  Pose T = Pose::Identity();
  T.translation() = Eigen::Vector3d(0.05, -0.04, 0.02);
  displace(surfels, T);
  for (std::size_t i = 0; i < surfels.size(); i += 4) {  // a quarter of them
    surfels[i].offset = 0.4;
  }
  const PlaneStep step = solve_plane_step(surfels, {0, 0, 0});
  ASSERT_TRUE(step.solved);
  EXPECT_LT((step.translation - T.translation()).norm(), 0.01);
}

TEST(PlaneStep, CovarianceCoversTheScatterOfManySolutions) {
  std::mt19937 random(3);
  std::normal_distribution<double> noise(0.0, 0.02);
  const Eigen::Vector3d reference(30.0, 0.0, 0.0);
  double squares = 0.0;
  double claimed = 0.0;
  constexpr int kTrials = 200;
  for (int trial = 0; trial < kTrials; ++trial) {
    auto surfels = box_surfels({0, 0, 0}, 30, random);
    for (SurfelObservation& s : surfels) {
      s.offset = noise(random);
    }
    const PlaneStep step = solve_plane_step(surfels, reference);
    ASSERT_TRUE(step.solved);
    squares += step.translation.squaredNorm() / kTrials;
    claimed += step.covariance_translation.trace() / kTrials;
  }
  EXPECT_GT(claimed, 2.0 * squares) << "inflated: independent noise is the best case";
  EXPECT_LT(claimed, 15.0 * squares);
}

TEST(PlaneStep, FreeDirectionIsNotSolved) {
  std::mt19937 random(4);
  auto surfels = box_surfels({0, 0, 0}, 100, random);
  std::erase_if(surfels,
                [](const SurfelObservation& s) { return std::abs(s.n_W.x()) > 0.5; });  // no transverse faces
  EXPECT_FALSE(solve_plane_step(surfels, {0, 0, 0}).solved);
}

TEST(PlaneStep, FewOrNoObservationsAreNotSolved) { EXPECT_FALSE(solve_plane_step({}, {0, 0, 0}).solved); }

}  // namespace
}  // namespace hulltrack
