// Is the frame that the benchmark times the one that it says it is? Not how long it takes.
#include <gtest/gtest.h>

#include <algorithm>

#include "daemon/pipeline/frame_pipeline.hpp"
#include "tests/support/bench_scene.hpp"
#include "tests/support/frame_recording.hpp"

namespace hulltrack::bench {
namespace {

constexpr std::uint32_t kSeed = 1;
constexpr std::uint32_t kFrames = 40;
constexpr std::uint32_t kFramesToBelieve = 30;  // the search of the berth, landmarks, recovery

void expect_map_of_a_ship(const HullMap& map) {
  EXPECT_NEAR(static_cast<double>(map.cloud_H().size()), 1.8e6, 0.1e6);
  EXPECT_GT(map.planes().planes().size(), 100'000U);
  EXPECT_GT(map.rims().size(), 1000U) << "hatches have coamings";
  EXPECT_GT(map.landmarks().size(), 200U);
  const auto movable = std::count_if(map.surfels().begin(), map.surfels().end(),
                                     [](const Surfel& surfel) { return surfel.movable; });
  EXPECT_GT(movable, 1000) << "there are holds for cargo and covers";
}

TEST(BenchScene, HullIsTrackedInFullScansWithClutter) {
  const auto map = std::make_shared<const HullMap>(make_scene(0.05, 0, kSeed).map_H);
  expect_map_of_a_ship(*map);
  const FrameRecording recording = record_frames(kFrames, kSeed);
  EXPECT_NEAR(recording.clutter, 0.31, 0.04);
  FramePipeline pipeline(config_for(recording), map);
  const Eigen::Vector3d amidships(0.0, 10.0, 2.0);
  std::uint32_t frames = 0;
  play(recording, [&](const Scan& scan) {
    EXPECT_NEAR(static_cast<double>(scan.points.size()), 65'000.0, 3000.0);
    const TrackResult track = pipeline.process(scan, recording.joints, {}).track;
    if (frames++ >= kFramesToBelieve) {
      EXPECT_EQ(track.state, State::tracking) << track.frame << ": " << track.reason;
    }
    if (track.health) {
      EXPECT_LT((track.pose.T_W_H * amidships - recording.T_W_H * amidships).norm(), 0.02) << track.frame;
    }
  });
  EXPECT_GE(frames, kFrames);
}

}  // namespace
}  // namespace hulltrack::bench
