// Covariances against the errors that they speak of: small errors are planted and carried through the
// transforms and the kinematics themselves.
#include "core/localisation/pose_covariance.hpp"

#include <gtest/gtest.h>

#include <Eigen/Eigenvalues>
#include <random>

#include "core/registration/plane_system.hpp"

namespace hulltrack {
namespace {

using Eigen::Vector3d;

/// [rotation; translation of `reference_W`] of what takes one pose to another, in W.
Twist difference(const Pose& from, const Pose& to, const Vector3d& reference_W) {
  const Pose step = to * from.inverse();
  Twist twist;
  twist << so3_log(step.linear()), step * reference_W - reference_W;
  return twist;
}

/// To `relative` of what each pair of sigmas allows, and rounding.
void expect_equal(const Matrix6& actual, const Matrix6& expected, double relative) {
  const double rounding = 1e-9 * expected.norm();
  for (int i = 0; i < 6; ++i) {
    for (int j = 0; j < 6; ++j) {
      EXPECT_NEAR(actual(i, j), expected(i, j),
                  relative * std::sqrt(expected(i, i) * expected(j, j)) + rounding)
          << i << ", " << j;
    }
  }
}

void expect_covariance(const Matrix6& covariance) {
  EXPECT_LT((covariance - covariance.transpose()).norm(), 1e-12 * covariance.norm());
  const Eigen::SelfAdjointEigenSolver<Matrix6> eigen(covariance, Eigen::EigenvaluesOnly);
  EXPECT_GT(eigen.eigenvalues()[0], -1e-12 * eigen.eigenvalues()[5]);
}

class CovarianceAtReference : public testing::Test {
 protected:
  /// A fit that is off by `error` about its centre has moved the scan, not the map: T_H_W.
  Twist error_at_reference(const Twist& error) const {
    const Pose found_H_W = pose_from_twist_about(centre_H, error) * T_W_H.inverse();
    return difference(T_W_H, found_H_W.inverse(), T_W_H * reference_H);
  }

  Pose T_W_H = pose_from_xyz_rpy_deg({12.0, -3.0, 1.5}, {2.0, -1.0, 35.0});
  Vector3d centre_H{7.0, -4.0, -2.0};
  Vector3d reference_H{-15.0, 3.0, 1.4};
};

TEST_F(CovarianceAtReference, IsThatOfPlantedErrors) {
  std::mt19937 random(11);
  std::normal_distribution<double> normal;
  // Rotations of 1 mrad and shifts of 1 cm, each correlated with all others.
  Matrix6 root;
  for (int i = 0; i < 6; ++i) {
    for (int j = 0; j < 6; ++j) {
      root(i, j) = normal(random) * (i < 3 ? 0.0004 : 0.004);
    }
  }
  const Matrix6 about_centre = root * root.transpose();
  const Matrix6 at_reference = covariance_at_reference(about_centre, centre_H, reference_H, T_W_H.linear());

  constexpr int kErrors = 40'000;
  Matrix6 scatter = Matrix6::Zero();
  for (int i = 0; i < kErrors; ++i) {
    const Twist drawn = root * Twist::NullaryExpr([&](Eigen::Index) { return normal(random); });
    const Twist error = error_at_reference(drawn);
    scatter += error * error.transpose() / kErrors;
  }
  expect_equal(at_reference, scatter, 5.0 * std::sqrt(2.0 / kErrors));
  expect_covariance(at_reference);
}

TEST_F(CovarianceAtReference, OfOneDirectionIsTheSquareOfThatErrorsShift) {
  constexpr double kSmall = 1e-6;
  for (int i = 0; i < 6; ++i) {
    const Twist error = kSmall * Twist::Unit(i);
    const Twist seen = error_at_reference(error);
    expect_equal(covariance_at_reference(error * error.transpose(), centre_H, reference_H, T_W_H.linear()),
                 seen * seen.transpose(), 1e-4);
  }
}

TEST_F(CovarianceAtReference, OfAFitAboutTheReferencePointInAlignedAxesIsItself) {
  Matrix6 covariance = Matrix6::Identity();
  covariance(0, 4) = covariance(4, 0) = 0.3;
  EXPECT_EQ(covariance_at_reference(covariance, reference_H, reference_H, Eigen::Matrix3d::Identity()),
            covariance);
}

class CovarianceOfJoints : public testing::Test {
 protected:
  CovarianceOfJoints() {
    machine.slew = pose_from_xyz_rpy_deg({1.0, 2.0, 12.0}, {0.0, 0.0, 90.0});
    machine.luff = pose_from_xyz_rpy_deg({3.0, 0.0, 6.0}, {0.0, 0.0, 0.0});
  }

  /// Samples `spacing_ms` apart of joints that move at `rate` a second and are at kJoints at 0.
  Matrix6 moving(const Joints& rate, int spacing_ms = 20) const {
    JointHistory history;
    for (int i = -2; i <= 2; ++i) {
      const double t = 0.001 * spacing_ms * (i + 0.5);
      history.add({MeasurementTime{} + std::chrono::microseconds(1000 * spacing_ms * i + 500 * spacing_ms),
                   {kJoints.d_x + t * rate.d_x, kJoints.theta_r + t * rate.theta_r,
                    kJoints.theta_p + t * rate.theta_p}});
    }
    return covariance_of_joints(machine, history, MeasurementTime{}, reference_W);
  }

  /// What the hull's pose is off by for each second that the joints are taken too late, seen alone.
  Twist slope(const Joints& rate) const {
    constexpr double kDt = 1e-5;
    const auto at = [&](double t) {
      return boom_pose(machine, {kJoints.d_x + t * rate.d_x, kJoints.theta_r + t * rate.theta_r,
                                 kJoints.theta_p + t * rate.theta_p});
    };
    return difference(at(-kDt), at(kDt), reference_W) / (2.0 * kDt);
  }

  static constexpr Joints kJoints{40.0, 0.4, -0.2};
  MachineConfig machine;
  Vector3d reference_W{55.0, 20.0, 3.0};
};

TEST_F(CovarianceOfJoints, IsZeroWhileTheyAreStill) {
  EXPECT_LT(moving({}).norm(), 1e-24);
  EXPECT_EQ(covariance_of_joints(machine, JointHistory(), MeasurementTime{}, reference_W), Matrix6::Zero())
      << "nothing is known of them";
}

TEST_F(CovarianceOfJoints, IsWhatTheKinematicsMakeOfAnErrorOfTheMoment) {
  // Two samples, each with a moment that is uniformly wrong by up to half a spacing: sigma of their mean.
  const double moment = 0.020 / std::sqrt(12.0) / std::sqrt(2.0);
  const Joints travel{0.5, 0.0, 0.0};
  const Joints slew{0.0, 0.02, 0.0};
  const Joints luff{0.0, 0.0, -0.01};
  Matrix6 sum = Matrix6::Zero();
  for (const Joints& rate : {travel, slew, luff}) {
    const Twist error = moment * slope(rate);
    expect_equal(moving(rate), error * error.transpose(), 0.06);
    sum += error * error.transpose();
  }
  const Matrix6 all = moving({0.5, 0.02, -0.01});
  expect_equal(all, sum, 0.06);  // their errors are independent
  expect_covariance(all);
}

TEST_F(CovarianceOfJoints, ATravellingGantryShiftsTheHullAlongTheQuayAlone) {
  const Matrix6 covariance = moving({0.5, 0.0, 0.0});
  EXPECT_NEAR(std::sqrt(covariance(3, 3)), 0.5 * 0.020 / std::sqrt(24.0), 0.05 * 0.002);
  EXPECT_NEAR(covariance.norm(), covariance(3, 3), 1e-12);
}

TEST_F(CovarianceOfJoints, GrowsWithTheSquareOfSpeedAndOfTheTimeBetweenSamples) {
  const Matrix6 one = moving({0.5, 0.02, -0.01});
  expect_equal(moving({1.0, 0.04, -0.02}), 4.0 * one, 1e-3);
  expect_equal(moving({0.5, 0.02, -0.01}, 100), 25.0 * one, 1e-3);
}

TEST(LargestSigma, IsTheLongestAxisOfTheEllipsoid) {
  const Eigen::Matrix3d R = rotation_from_rpy({0.3, -0.5, 1.1});
  const Eigen::Matrix3d covariance = R * Vector3d(0.01, 0.09, 0.04).asDiagonal() * R.transpose();
  EXPECT_NEAR(largest_sigma(covariance), 0.3, 1e-12);
  EXPECT_EQ(largest_sigma(Eigen::Matrix3d::Zero()), 0.0);
  EXPECT_EQ(largest_sigma(-1e-18 * Eigen::Matrix3d::Identity()), 0.0) << "rounding below zero";
}

}  // namespace
}  // namespace hulltrack
