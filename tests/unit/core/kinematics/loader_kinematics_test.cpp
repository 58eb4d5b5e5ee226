#include "core/kinematics/loader_kinematics.hpp"

#include <gtest/gtest.h>

namespace hulltrack {
namespace {

using Eigen::Vector3d;

TEST(LoaderKinematics, TravelMovesTheSensorAlongX) {
  const Pose T = lidar_pose({}, {10.0, 0.0, 0.0}, Pose::Identity());
  EXPECT_LT((T * Vector3d::Zero() - Vector3d(10.0, 0.0, 0.0)).norm(), 1e-12);
}

TEST(LoaderKinematics, PositiveLuffLowersABoomAlongX) {
  const Pose T = boom_pose({}, {0.0, 0.0, radians(10.0)});
  EXPECT_LT((T * Vector3d(30.0, 0.0, 0.0)).z(), -5.0);
}

TEST(LoaderKinematics, EqualsTheChainWrittenOutByHand) {
  MachineConfig machine;
  machine.slew = pose_from_xyz_rpy_deg({1.0, 2.0, 12.0}, {0.0, 0.0, 90.0});
  machine.luff = pose_from_xyz_rpy_deg({3.0, 0.0, 6.0}, {0.0, 0.0, 0.0});
  const Pose T_lidar = pose_from_xyz_rpy_deg({35.0, 0.0, -1.0}, {0.0, 90.0, 0.0});
  const Pose T = lidar_pose(machine, {100.0, radians(90.0), radians(90.0)}, T_lidar);
  // By hand, sensor origin: (35,0,-1) luffed by 90 deg -> (-1,0,-35); + luff (3,0,6) -> (2,0,-29);
  // slewed by 90 deg -> (0,2,-29); slew frame turned by 90 deg -> (-2,0,-29); + (1,2,12); + travel.
  EXPECT_LT((T.translation() - Vector3d(99.0, 2.0, -17.0)).norm(), 1e-9);
  // Sensor x: mount pitches it to -z of the boom; luff turns -z to -x; slew to -y; frame to +x.
  EXPECT_LT((T.linear() * Vector3d::UnitX() - Vector3d::UnitX()).norm(), 1e-9);
}

}  // namespace
}  // namespace hulltrack
