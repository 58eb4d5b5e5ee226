#include "core/registration/rigid_fit.hpp"

#include <gtest/gtest.h>

#include <random>

namespace hulltrack {
namespace {

using Points = Eigen::Matrix<double, 3, Eigen::Dynamic>;

Points random_points(Eigen::Index count, unsigned seed) {
  std::mt19937 rng(seed);
  std::normal_distribution<double> n;
  return Points::NullaryExpr(3, count, [&] { return 10.0 * n(rng); });
}

RigidFit fit_of(const Points& moving, const Points& fixed) {
  RigidFit fit(fixed.col(0));
  for (Eigen::Index i = 0; i < moving.cols(); ++i) {
    fit.add(moving.col(i), fixed.col(i));
  }
  return fit;
}

TEST(RigidFit, EqualsEigensUmeyamaOnNoisyPairs) {
  for (unsigned seed = 1; seed < 20; ++seed) {
    const Points moving = random_points(3 + 5 * seed, seed).colwise() + Eigen::Vector3d(300.0, -200.0, 20.0);
    Twist xi;
    xi << 0.1 * seed, -0.05, 0.02 * seed, 1.0, -2.0, 0.5;
    const Points fixed = (se3_exp(xi) * moving) + 0.01 * random_points(moving.cols(), 100 + seed);
    const Eigen::Matrix4d expected = Eigen::umeyama(moving, fixed, false);
    const auto motion = fit_of(moving, fixed).solve();
    ASSERT_TRUE(motion);
    EXPECT_LT((motion->pose().matrix() - expected).norm(), 1e-8);
    EXPECT_LT((motion->centre - moving.rowwise().mean()).norm(), 1e-9);
    EXPECT_LT((motion->translation - (fixed - moving).rowwise().mean()).norm(), 1e-9);
  }
}

TEST(RigidFit, NeverReflects) {
  // A flat set of points and its mirror image: the best orthogonal matrix would be a reflection.
  Points moving = random_points(30, 2);
  moving.row(2) *= 1e-3;
  Points fixed = moving;
  fixed.row(2) *= -1.0;
  const auto motion = fit_of(moving, fixed).solve();
  ASSERT_TRUE(motion);
  EXPECT_NEAR(motion->rotation.determinant(), 1.0, 1e-12);
}

TEST(RigidFit, RefusesWhatLeavesARotationFree) {
  const Points line = Eigen::Vector3d(1.0, 2.0, -0.5) * Eigen::RowVectorXd::LinSpaced(20, -30.0, 30.0);
  EXPECT_FALSE(fit_of(line, line).solve());
  const Points one_place = Eigen::Vector3d(1.0, 2.0, 3.0) * Eigen::RowVectorXd::Ones(20);
  EXPECT_FALSE(fit_of(one_place, one_place).solve());
  const Points two = random_points(2, 3);
  EXPECT_FALSE(fit_of(two, two).solve());
  EXPECT_FALSE(RigidFit(Eigen::Vector3d::Zero()).solve());
}

TEST(RigidFit, AcceptsAPlane) {
  Points plane = random_points(40, 4);
  plane.row(1).setConstant(3.0);
  Twist xi;
  xi << 0.01, 0.02, -0.03, 0.1, 0.2, 0.3;
  const auto motion = fit_of(plane, se3_exp(xi) * plane).solve();
  ASSERT_TRUE(motion);
  EXPECT_LT((motion->pose().matrix() - se3_exp(xi).matrix()).norm(), 1e-10);
}

TEST(RigidFit, NormalMatrixEqualsFiniteDifferences) {
  const Points moving = random_points(25, 5).colwise() + Eigen::Vector3d(100.0, 50.0, 0.0);
  const RigidFit fit = fit_of(moving, moving);
  const Eigen::Vector3d centre = fit.centroid();
  Eigen::MatrixXd J(moving.size(), 6);
  constexpr double kStep = 1e-6;
  for (int k = 0; k < 6; ++k) {
    const Points ahead =
        (se3_exp(kStep * Twist::Unit(k)) * Points(moving.colwise() - centre)).colwise() + centre;
    const Points behind =
        (se3_exp(-kStep * Twist::Unit(k)) * Points(moving.colwise() - centre)).colwise() + centre;
    J.col(k) = ((ahead - behind) / (2.0 * kStep)).reshaped();
  }
  const Matrix6 expected = J.transpose() * J;
  EXPECT_LT((fit.normal_matrix() - expected).norm(), 1e-6 * expected.norm());
}

}  // namespace
}  // namespace hulltrack
