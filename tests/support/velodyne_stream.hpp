// A Velodyne on the bench.
#pragma once

#include "lidar_drivers/sim/velodyne_encoder.hpp"
#include "tests/support/lidar_stream.hpp"

namespace hulltrack::test {

using VelodyneStream = LidarStream;

}  // namespace hulltrack::test
