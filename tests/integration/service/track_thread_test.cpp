// The track thread alone: this test plays rx and plc, and says when scans and joint samples come.
#include "daemon/service/track_thread.hpp"

#include <gtest/gtest.h>

#include <memory>
#include <thread>

#include "daemon/pipeline/live_time.hpp"
#include "daemon/threads/guarded_thread.hpp"
#include "tests/integration/service/loader_bench.hpp"

namespace hulltrack {
namespace {

using std::chrono::milliseconds;

class TrackThreadTest : public testing::Test {
 protected:
  /// The thread's patience ends long after the test, however slow the machine.
  static Prepared patient(Prepared prepared) {
    prepared.config.plc.response_timeout = std::chrono::minutes(10);
    return prepared;
  }
  void sample(milliseconds after_start) { exchange.joints.push({start + after_start, {}}); }
  void scan(std::uint32_t number, milliseconds first, milliseconds last) {
    Scan& scan = exchange.scans.writable();
    scan.clear();
    scan.frame_number = number;
    scan.begin = scan.first_firing = start + first;
    scan.end = scan.last_firing = start + last;
    exchange.scans.publish();
  }
  /// Rings, and returns when the thread has seen all that was there before. It beats before it looks, so only
  /// the second beat says that a look begun after the ring has ended.
  void ring() {
    for (int turn = 0; turn < 2; ++turn) {
      const SteadyTime rung = steady_now();
      exchange.track_bell.ring();
      while (pulse.silence(rung) >= Nanoseconds::zero()) std::this_thread::yield();
    }
  }
  FrameDone next_frame() {
    FrameDone frame = exchange.frame.get();
    while (frame.sequence <= seen) {
      std::this_thread::yield();
      frame = exchange.frame.get();
    }
    seen = frame.sequence;
    return frame;
  }

  Prepared prepared = patient(room_service(1, 1));
  Exchange exchange;
  Pulse pulse{"track", std::chrono::seconds(1), steady_now()};
  MeasurementTime start = live_measurement_time(steady_now());
  std::uint64_t seen = 0;
  TrackThread thread{prepared.config, prepared.map, prepared.quay, exchange, pulse};
  GuardedThread runner{"track", [this](std::stop_token stop) { thread.run(stop); },
                       [](const std::string&, const std::string& what) { ADD_FAILURE() << what; },
                       [this] { exchange.track_bell.ring(); }};
};

TEST_F(TrackThreadTest, ANewerScanDoesNotMakeAnOlderOneGiveUpItsJoints) {
  sample(milliseconds(0));
  scan(0, milliseconds(10), milliseconds(110));
  ring();
  scan(1, milliseconds(110), milliseconds(210));
  ring();
  ring();
  EXPECT_EQ(exchange.frame.get().sequence, 0U) << "a poll was lost, but the next one still brackets";
  sample(milliseconds(150));
  ring();
  const FrameDone first = next_frame();
  EXPECT_EQ(first.result.frame, 0U);
  EXPECT_EQ(first.result.faults & fault::plc_stale, 0);
  sample(milliseconds(220));
  ring();
  const FrameDone second = next_frame();
  EXPECT_EQ(second.result.frame, 1U);
  EXPECT_EQ(second.result.faults & fault::plc_stale, 0);
}

TEST_F(TrackThreadTest, AScanReplacedWhileJointsAreAwaitedIsNotLate) {
  sample(milliseconds(0));
  scan(0, milliseconds(10), milliseconds(110));
  ring();
  ring();  // it has the scan, and waits for the sample behind it
  const auto publish = [&] {
    exchange.scans.writable().clear();
    return exchange.publish_scan();
  };
  EXPECT_FALSE(publish());
  EXPECT_FALSE(publish()) << "replaced, by no fault of the processing";
  EXPECT_TRUE(exchange.awaiting_joints);
  sample(milliseconds(120));
  ring();
  (void)next_frame();
}

TEST(Exchange, AScanReplacedWhileTrackIsBusyIsLate) {
  const auto exchange = std::make_unique<Exchange>();
  EXPECT_FALSE(exchange->publish_scan());
  EXPECT_TRUE(exchange->publish_scan());
}

TEST_F(TrackThreadTest, AFrameOfJointsOnTrialSaysWhyItIsNotHealthy) {
  exchange.plc.put({.standing = fault::plc_value, .joint_trouble = "travel waits"});
  exchange.joints.push({start, {}, true});
  scan(0, milliseconds(10), milliseconds(110));
  exchange.joints.push({start + milliseconds(120), {}, true});
  ring();
  const FrameDone frame = next_frame();
  EXPECT_FALSE(frame.result.health);
  EXPECT_NE(frame.result.faults & fault::plc_value, 0);
  EXPECT_EQ(frame.first_firing, start + milliseconds(10));
  EXPECT_EQ(frame.last_firing, start + milliseconds(110));
}

TEST_F(TrackThreadTest, AGapInTheJointsIsToldAtOnce) {
  sample(milliseconds(0));
  scan(0, milliseconds(10), milliseconds(110));
  ring();
  sample(milliseconds(251));
  ring();
  const FrameDone frame = next_frame();
  EXPECT_NE(frame.result.faults & fault::plc_stale, 0);
  EXPECT_FALSE(frame.result.health);
}

}  // namespace
}  // namespace hulltrack
