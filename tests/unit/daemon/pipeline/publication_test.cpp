#include "daemon/pipeline/publication.hpp"

#include <gtest/gtest.h>

#include "daemon/pipeline/command_word.hpp"
#include "daemon/pipeline/plc_reading.hpp"

namespace hulltrack {
namespace {

using std::chrono::milliseconds;

constexpr MeasurementTime kStart{std::chrono::seconds(1000)};

TrackResult healthy_frame(MeasurementTime mid, std::uint32_t number, double x) {
  TrackResult r;
  r.frame = number;
  r.time = MeasurementTime{mid.time_since_epoch()};
  r.registered = r.converged = r.health = true;
  r.state = State::tracking;
  r.pose = moved_hull({x, 0.2, 0.3}, rotation_from_rpy({radians(0.1), radians(0.2), radians(0.3)}));
  r.sigma_translation = 0.01;
  r.sigma_rotation = radians(0.02);
  r.metrics = {true, 0.07, 0.08, 0.09, 0.1, 0.11, 1000};
  r.matched = 900;
  return r;
}

TrackResult lost_frame(MeasurementTime mid, std::uint32_t number) {
  TrackResult r = healthy_frame(mid, number, 99.0);
  r.health = false;
  r.state = State::lost;
  r.faults = fault::contradicted | fault::implausible;
  r.metrics.q1 = 0.4;
  return r;
}

TEST(Publication, BeforeTheFirstFrameEverythingIsUnknown) {
  Publication publication(milliseconds(500));
  EXPECT_EQ(publication.block({}, kStart), WriteBlock{});
}

TEST(Publication, OutOfServiceIsAFaultUnlessHeldOrStopped) {
  Publication publication(milliseconds(500));
  const WriteBlock waiting = publication.block({.out_of_service = true}, kStart);
  EXPECT_EQ(waiting.state, State::fault);
  EXPECT_FALSE(waiting.health);
  EXPECT_EQ(publication.block({.out_of_service = true, .command = kCommandHold}, kStart).state, State::held);
  EXPECT_EQ(publication.block({.stopped = true, .out_of_service = true}, kStart).state, State::stopped);
}

TEST(Publication, HealthyFrameIsPublishedWithItsAge) {
  Publication publication(milliseconds(500));
  publication.frame(healthy_frame(kStart, 7, 0.1), kStart + milliseconds(60), milliseconds(11));
  const WriteBlock b = publication.block({}, kStart + milliseconds(80));
  EXPECT_TRUE(b.health);
  EXPECT_EQ(b.state, State::tracking);
  EXPECT_EQ(b.frame, 7u);
  EXPECT_DOUBLE_EQ(b.x_m, 0.1);
  EXPECT_NEAR(b.yaw_deg, 0.3, 1e-12);
  EXPECT_DOUBLE_EQ(b.q1_m, 0.07);
  EXPECT_EQ(b.matched, 900u);
  EXPECT_NEAR(b.age_ms, 80.0, 1e-9);
  EXPECT_NEAR(b.sigma_rotation_deg, 0.02, 1e-12);
  EXPECT_NEAR(b.processing_ms, 11.0, 1e-9);
}

TEST(Publication, PoseThatFailedItsCheckIsNeverWritten) {
  Publication publication(milliseconds(500));
  publication.frame(healthy_frame(kStart, 7, 0.1), kStart, {});
  (void)publication.block({}, kStart);
  publication.frame(lost_frame(kStart + milliseconds(100), 8), kStart + milliseconds(100), {});
  const WriteBlock b = publication.block({}, kStart + milliseconds(150));
  EXPECT_FALSE(b.health);
  EXPECT_EQ(b.state, State::lost);
  EXPECT_EQ(b.frame, 7u);
  EXPECT_DOUBLE_EQ(b.x_m, 0.1);
  EXPECT_NEAR(b.age_ms, 150.0, 1e-9) << "its age keeps growing";
  EXPECT_DOUBLE_EQ(b.q1_m, 0.4) << "figures are the newest frame's";
}

TEST(Publication, HealthyFrameThatWasNeverPublishedLeavesThePose) {
  Publication publication(milliseconds(500));
  publication.frame(healthy_frame(kStart, 7, 0.1), kStart, {});
  PublicationContext held;
  held.command = kCommandHold;
  const WriteBlock b = publication.block(held, kStart);
  EXPECT_FALSE(b.health);
  EXPECT_EQ(b.state, State::held);
  EXPECT_EQ(b.x_m, 0.0);
  EXPECT_EQ(b.age_ms, kUnknownAgeMs);
  EXPECT_EQ(b.command_echo, kCommandHold);
}

TEST(Publication, HealthFallsWithAgeWhateverTheTrackerSaid) {
  Publication publication(milliseconds(500));
  publication.frame(healthy_frame(kStart, 7, 0.1), kStart, {});
  EXPECT_TRUE(publication.block({}, kStart + milliseconds(500)).health);
  const WriteBlock b = publication.block({}, kStart + milliseconds(501));
  EXPECT_FALSE(b.health);
  EXPECT_EQ(b.state, State::degraded);
}

TEST(Publication, APoseFromTheFutureIsNoFresherThanAnOldOne) {
  Publication publication(milliseconds(500));
  publication.frame(healthy_frame(kStart, 7, 0.1), kStart, {});
  EXPECT_TRUE(publication.block({}, kStart - milliseconds(500)).health);
  EXPECT_FALSE(publication.block({}, kStart - milliseconds(501)).health);
}

TEST(Publication, AnotherConfigurationKeepsThePoseAndTheFramesRise) {
  Publication publication(milliseconds(500));
  publication.frame(healthy_frame(kStart, 7, 0.1), kStart, {});
  (void)publication.block({}, kStart);
  publication.begin_anew(milliseconds(300));
  publication.begin_anew(milliseconds(200));  // twice before its first frame
  const WriteBlock b = publication.block({}, kStart + milliseconds(100));
  EXPECT_FALSE(b.health);
  EXPECT_EQ(b.state, State::starting);
  EXPECT_EQ(b.frame, 7u);
  EXPECT_DOUBLE_EQ(b.x_m, 0.1);
  EXPECT_NEAR(b.sigma_translation_m, 0.01, 1e-12);
  EXPECT_NEAR(b.age_ms, 100.0, 1e-9);
  publication.frame(healthy_frame(kStart + milliseconds(200), 0, 0.4), kStart + milliseconds(250), {});
  EXPECT_EQ(publication.block({}, kStart + milliseconds(250)).frame, 8u);
  EXPECT_FALSE(publication.block({}, kStart + milliseconds(401)).health) << "the new max_age holds";
}

TEST(Publication, EventBitsStayForASecondAndConditionsAsLongAsTheyHold) {
  Publication publication(milliseconds(500));
  publication.frame(lost_frame(kStart, 1), kStart, {});
  publication.events(fault::frame_dropped, kStart);
  publication.frame(healthy_frame(kStart + milliseconds(100), 2, 0.0), kStart + milliseconds(100), {});
  PublicationContext context;
  context.standing = fault::clock;
  const Faults events = fault::implausible | fault::frame_dropped;
  EXPECT_EQ(publication.block(context, kStart + milliseconds(1000)).faults, events | fault::clock);
  EXPECT_EQ(publication.block({}, kStart + milliseconds(1500)).faults, 0);
}

TEST(Publication, OneOfSeveralLidarsSilentIsDegradedAndItsFaultNotTheEnd) {
  Publication publication(milliseconds(500));
  publication.frame(healthy_frame(kStart, 1, 0.0), kStart, {});
  PublicationContext context;
  context.standing = fault::lidar_silent;
  const WriteBlock block = publication.block(context, kStart);
  EXPECT_EQ(block.state, State::degraded);
  EXPECT_FALSE(block.health);
  EXPECT_EQ(block.faults, fault::lidar_silent);
  EXPECT_TRUE(publication.block({}, kStart).health) << "it is back";
}

TEST(Publication, TheHighestStateThatAppliesIsWritten) {
  Publication publication(milliseconds(500));
  PublicationContext context;
  context.every_lidar_silent = true;
  EXPECT_EQ(publication.block(context, kStart).state, State::starting) << "no frame yet: 0 before 5";
  publication.frame(healthy_frame(kStart, 1, 0.0), kStart, {});
  EXPECT_EQ(publication.block(context, kStart).state, State::fault);
  context.every_lidar_silent = false;
  context.standing = fault::plc_stale;
  EXPECT_EQ(publication.block(context, kStart).state, State::fault);
  context.standing = fault::map_unusable;
  EXPECT_EQ(publication.block(context, kStart).state, State::fault);
  context.command = kCommandHold;
  EXPECT_EQ(publication.block(context, kStart).state, State::held);
  context.stopped = true;
  const WriteBlock last = publication.block(context, kStart);
  EXPECT_EQ(last.state, State::stopped);
  EXPECT_FALSE(last.health);
}

TEST(Publication, HealthIsOneIfAndOnlyIfTheStateIsTracking) {
  for (std::uint16_t s = 0; s <= 7; ++s) {
    Publication publication(milliseconds(500));
    TrackResult r = healthy_frame(kStart, 1, 0.0);
    r.state = static_cast<State>(s);
    r.health = r.state == State::tracking;
    publication.frame(r, kStart, {});
    const WriteBlock b = publication.block({}, kStart);
    EXPECT_EQ(b.health, b.state == State::tracking);
  }
}

TEST(CommandLatch, KeepsAnEdgeUntilItIsTaken) {
  CommandLatch latch;
  EXPECT_TRUE(latch.read(kCommandReacquire));
  EXPECT_FALSE(latch.read(kCommandReacquire)) << "a level is not an edge";
  EXPECT_FALSE(latch.read(0));
  EXPECT_TRUE(latch.take_reacquire());
  EXPECT_FALSE(latch.take_reacquire());
  EXPECT_TRUE(latch.read(kCommandReacquire | kCommandHold));
  EXPECT_TRUE(latch.hold());
}

TEST(PlcReading, AFrozenHeartbeatBringsNeitherCommandNorJoints) {
  const JointLimits limits{-100.0, 100.0, 1.0};
  JointGate gate({.travel = limits, .slew = limits, .luff = limits});
  CommandLatch latch;
  const auto offer = [&](int ms, double travel, std::uint16_t heartbeat, std::uint16_t command) {
    const MeasurementTime time{milliseconds(1'000'000 + ms)};
    return take_plc_reading({{time, {travel, 0.0, 0.0}}, heartbeat}, command, latch, gate).verdict;
  };
  EXPECT_EQ(offer(0, 1.0, 5, 0), JointGate::Verdict::believed);
  EXPECT_EQ(offer(20, 1.0, 5, kCommandHold | kCommandReacquire), JointGate::Verdict::no_news);
  EXPECT_EQ(latch.command(), 0);
  EXPECT_FALSE(latch.take_reacquire());
  EXPECT_EQ(offer(40, 50.0, 6, kCommandReacquire), JointGate::Verdict::believed) << "the edge comes first";
  EXPECT_TRUE(latch.take_reacquire());
  EXPECT_EQ(offer(60, 1.0, 7, kCommandHold), JointGate::Verdict::refused);
  EXPECT_TRUE(latch.hold()) << "news with a joint that is refused is news all the same";
}

}  // namespace
}  // namespace hulltrack
