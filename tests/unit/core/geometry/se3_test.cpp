#include "core/geometry/se3.hpp"

#include <gtest/gtest.h>

#include <random>
#include <unsupported/Eigen/MatrixFunctions>

namespace hulltrack {
namespace {

class RandomTwists : public ::testing::Test {
 protected:
  std::mt19937 rng_{7};
  Twist draw(double max_angle) {
    std::uniform_real_distribution<double> u(-1.0, 1.0);
    Twist xi = Twist::NullaryExpr([&] { return u(rng_); });
    xi.head<3>() *= max_angle / xi.head<3>().norm() * std::abs(u(rng_));
    xi.tail<3>() *= 50.0;
    return xi;
  }
};

// Independent of our closed forms: Eigen's general matrix exponential of the 4 x 4 generator.
Eigen::Matrix4d general_exponential(const Twist& xi) {
  Eigen::Matrix4d generator = Eigen::Matrix4d::Zero();
  generator.topLeftCorner<3, 3>() = skew(xi.head<3>());
  generator.topRightCorner<3, 1>() = xi.tail<3>();
  return generator.exp();
}

TEST_F(RandomTwists, ExponentialEqualsGeneralMatrixExponential) {
  for (const double max_angle : {1e-9, 1e-6, 1e-4, 0.1, 3.0}) {
    for (int i = 0; i < 50; ++i) {
      const Twist xi = draw(max_angle);
      EXPECT_LT((se3_exp(xi).matrix() - general_exponential(xi)).norm(), 1e-10 * (1.0 + xi.norm()));
    }
  }
}

TEST_F(RandomTwists, LogarithmInvertsExponential) {
  for (const double max_angle : {1e-9, 1e-6, 1e-4, 0.1, 3.1}) {
    for (int i = 0; i < 50; ++i) {
      const Twist xi = draw(max_angle);
      EXPECT_LT((se3_log(se3_exp(xi)) - xi).norm(), 1e-9 * (1.0 + xi.norm()));
    }
  }
}

TEST(RollPitchYaw, ComposesAsYawTimesPitchTimesRoll) {
  const Eigen::Matrix3d yaw = rotation_from_rpy({0.0, 0.0, radians(90.0)});
  EXPECT_LT((yaw * Eigen::Vector3d::UnitX() - Eigen::Vector3d::UnitY()).norm(), 1e-12);
  const Eigen::Matrix3d pitch = rotation_from_rpy({0.0, radians(90.0), 0.0});
  EXPECT_LT((pitch * Eigen::Vector3d::UnitX() + Eigen::Vector3d::UnitZ()).norm(), 1e-12);
  const Eigen::Matrix3d roll = rotation_from_rpy({radians(90.0), 0.0, 0.0});
  EXPECT_LT((roll * Eigen::Vector3d::UnitY() - Eigen::Vector3d::UnitZ()).norm(), 1e-12);
  const Eigen::Vector3d rpy(0.3, -0.7, 2.9);
  EXPECT_LT(
      (rotation_from_rpy(rpy) - yaw.transpose() * yaw * rotation_from_rpy({0, 0, rpy.z()}) *
                                    rotation_from_rpy({0, rpy.y(), 0}) * rotation_from_rpy({rpy.x(), 0, 0}))
          .norm(),
      1e-12);
}

TEST(RollPitchYaw, InvertsAwayFromTheSingularityAndStaysFiniteAtIt) {
  std::mt19937 rng(3);
  std::uniform_real_distribution<double> u(-1.0, 1.0);
  for (int i = 0; i < 200; ++i) {
    const Eigen::Vector3d rpy(3.1 * u(rng), 1.5 * u(rng), 3.1 * u(rng));
    EXPECT_LT((rpy_from_rotation(rotation_from_rpy(rpy)) - rpy).norm(), 1e-9);
  }
  const Eigen::Matrix3d R = rotation_from_rpy({0.4, std::numbers::pi / 2.0, 0.9});
  const Eigen::Vector3d rpy = rpy_from_rotation(R);
  ASSERT_TRUE(rpy.allFinite());
  EXPECT_LT((rotation_from_rpy(rpy) - R).norm(), 1e-7);
}

TEST(RotationAngle, IsExactNearPi) {
  const Eigen::Vector3d axis = Eigen::Vector3d(1.0, -2.0, 0.5).normalized();
  for (const double angle : {0.0, 1e-7, 1.0, 3.14159, std::numbers::pi}) {
    EXPECT_NEAR(rotation_angle(Eigen::AngleAxisd(angle, axis).toRotationMatrix()), angle, 1e-7);
  }
}

TEST_F(RandomTwists, ASmallMotionIsTheSameAboutAnyPoint) {
  const Twist about_origin = 1e-6 * draw(1.0);
  const Eigen::Vector3d away(3.0, -40.0, 12.0);
  const Twist about_there = about_point(away, about_origin);
  const Eigen::Vector3d p(10.0, 20.0, 30.0);
  const Eigen::Vector3d moved = about_origin.tail<3>() + about_origin.head<3>().cross(p);
  EXPECT_TRUE(moved.isApprox(about_there.tail<3>() + about_there.head<3>().cross(p - away)));
}

}  // namespace
}  // namespace hulltrack
