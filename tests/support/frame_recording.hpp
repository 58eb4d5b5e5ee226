// Some seconds of a loader at work over the bench scene's ship, as datagrams: the whole frame's case.
//
// One spinning LiDAR of 32 lasers hangs askew under the travelling boom, so that the half of its rays that
// points down meets decks, holds, quay and dust. It turns five times a second and a frame is a turn: about
// 65,000 points. The hull is off its map by T_W_H. Frames as in the project; metres, rad.
// Deterministic for a seed. Cost: a tenth of a second a frame.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "core/kinematics/joint_history.hpp"
#include "daemon/config/config.hpp"
#include "lidar_drivers/scan_builder.hpp"

namespace hulltrack::bench {

struct RecordedDatagram {
  MeasurementTime received;
  std::vector<std::uint8_t> bytes;
};

struct FrameRecording {
  LidarConfig lidar;
  FramingConfig framing;
  Pose T_W_H;
  JointHistory joints;  // all of them
  std::vector<RecordedDatagram> datagrams;
  double clutter = 0.0;  // share of the returns that are not hull, dust included
};

/// Enough datagrams for `frames` whole frames.
[[nodiscard]] FrameRecording record_frames(int frames, std::uint32_t seed);

/// All defaults but for the recording's LiDAR.
[[nodiscard]] Config config_for(const FrameRecording& recording);

/// Datagrams in, on_scan(scan) for every frame.
template <typename OnScan>
void play(const FrameRecording& recording, OnScan&& on_scan) {
  ScanBuilder builder = ScanBuilder::create({recording.lidar}, recording.framing).value();
  Scan scan;
  for (const RecordedDatagram& datagram : recording.datagrams) {
    builder.add(0, {.bytes = datagram.bytes, .received = datagram.received});
    if (builder.take(scan)) {
      on_scan(scan);
    }
  }
}

}  // namespace hulltrack::bench
