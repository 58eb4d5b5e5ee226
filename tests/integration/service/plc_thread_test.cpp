// The plc thread alone, with a tracker that this test plays: what the registers say must not depend on it.
#include "daemon/service/plc_thread.hpp"

#include <gtest/gtest.h>

#include <atomic>
#include <functional>
#include <thread>

#include "daemon/pipeline/live_time.hpp"
#include "daemon/threads/guarded_thread.hpp"
#include "tests/integration/service/loader_bench.hpp"
#include "tests/support/recording_log.hpp"

namespace hulltrack {
namespace {

constexpr std::chrono::milliseconds kMaxAge{2000};

class PlcThreadTest : public testing::Test {
 protected:
  static FrameDone healthy_frame(std::uint64_t sequence) {
    FrameDone frame;
    frame.sequence = sequence;
    frame.last_received = frame.done = steady_now();
    frame.result.frame = static_cast<std::uint32_t>(sequence);
    frame.result.time = live_measurement_time(frame.done);
    frame.result.registered = frame.result.converged = frame.result.health = true;
    frame.result.pose.T_W_H.translation() = Eigen::Vector3d(0.1, 0.2, 0.3);
    frame.result.state = State::tracking;
    return frame;
  }
  /// A pose stays young, and a reply is awaited, for longer than a busy machine may take.
  static Config patient(Config config) {
    config.tracker.health.max_age = kMaxAge;
    config.plc.response_timeout = std::chrono::seconds(10);
    return config;
  }
  void deliver(const FrameDone& frame) {
    exchange.frame.put(frame);
    exchange.plc_bell.ring();
  }

  RecordingLog log;
  CyclingPlc plc;
  Config config = patient(room_service(1, plc.server().port()).config);
  Exchange exchange;
  Pulse pulse{"plc", std::chrono::seconds(1), steady_now()};
  PlcThread thread{config, exchange, pulse, log, {}};
};

class RunningPlcThreadTest : public PlcThreadTest {
 protected:
  GuardedThread runner{"plc", [this](std::stop_token stop) { thread.run(stop); },
                       [](const std::string&, const std::string& what) { ADD_FAILURE() << what; },
                       [this] { exchange.plc_bell.ring(); }};
};

TEST_F(RunningPlcThreadTest, AStuckTrackerCanNeverLookHealthy) {
  deliver(healthy_frame(1));
  const auto healthy = plc.wait_for([](const WriteBlock& block) { return block.health; }, 0);
  ASSERT_TRUE(healthy);
  EXPECT_NEAR(healthy->x_m, 0.1, 1e-6);
  // No further frame: the age grows at every write until the health falls by itself.
  const auto expired = plc.wait_for([](const WriteBlock& block) { return !block.health; });
  ASSERT_TRUE(expired);
  EXPECT_GT(expired->age_ms, static_cast<double>(kMaxAge.count()));
  EXPECT_NEAR(expired->x_m, 0.1, 1e-6) << "the last good pose stays";
  for (const WriteBlock& block : plc.blocks()) {
    ASSERT_TRUE(!block.health || block.age_ms <= static_cast<double>(kMaxAge.count()));
  }
}

TEST_F(RunningPlcThreadTest, AnRxThreadThatStoppedLookingCountsAsSilence) {
  deliver(healthy_frame(1));
  ASSERT_TRUE(plc.wait_for([](const WriteBlock& block) { return block.health; }, 0));
  exchange.lidars.put({.standing = 0, .every_silent = false, .updated = steady_now()});
  EXPECT_TRUE(plc.wait_for([](const WriteBlock& block) { return block.state == State::fault; }));
}

TEST_F(RunningPlcThreadTest, EventsStandInTheRegisters) {
  deliver(healthy_frame(1));
  exchange.events.raise(fault::frame_dropped | fault::foreign_packets);
  EXPECT_TRUE(plc.wait_for([](const WriteBlock& block) {
    return (block.faults & fault::frame_dropped) != 0 && (block.faults & fault::foreign_packets) != 0;
  }));
}

TEST_F(PlcThreadTest, AWriteThatMeetsABusyPlcIsTriedAgainAtTheNextPoll) {
  Config seldom = config;
  seldom.plc.write_period = std::chrono::hours(1);
  plc.server().set_fault(sim::PlcFault::busy, 4);  // two polls and the writes behind them
  PlcThread slow{seldom, exchange, pulse, log, {}};
  GuardedThread runner(
      "plc", [&](std::stop_token stop) { slow.run(stop); },
      [](const std::string&, const std::string& what) { ADD_FAILURE() << what; },
      [this] { exchange.plc_bell.ring(); });
  EXPECT_TRUE(plc.wait_for([](const WriteBlock&) { return true; }, 0)) << "not before the next period";
}

TEST_F(PlcThreadTest, AJumpOfAJointStandsInTheRegistersAndWaitsForAnEdge) {
  // What the server's owner sets in between is gone at the next cycle of CyclingPlc, so this one cycles
  // itself.
  sim::PlcServer server{{}};
  Config jumpy = config;
  jumpy.plc.port = server.port();
  std::atomic<double> travel = 0.0;
  std::jthread cycle([&](const std::stop_token& stop) {
    while (!stop.stop_requested()) {
      server.set_joints(travel, 0.0, 0.0);
      std::this_thread::sleep_for(std::chrono::milliseconds(10));
    }
  });
  PlcThread other{jumpy, exchange, pulse, log, {}};
  GuardedThread runner(
      "plc", [&](std::stop_token stop) { other.run(stop); },
      [](const std::string&, const std::string& what) { ADD_FAILURE() << what; },
      [this] { exchange.plc_bell.ring(); });
  const auto wait_until = [&](const std::function<bool(const PlcView&)>& law) {
    const auto deadline = std::chrono::steady_clock::now() + std::chrono::minutes(1);
    while (!law(exchange.plc.get()) && std::chrono::steady_clock::now() < deadline) std::this_thread::yield();
    return law(exchange.plc.get());
  };
  JointHistory joints;
  const auto believed = [&](const PlcView& view) {
    exchange.joints.drain_into(joints);
    return view.standing == 0 && joints.size() > 0 && joints.newest()->joints.d_x == travel;
  };
  ASSERT_TRUE(wait_until(believed));
  // What breaks off within half a second of a start is a start again.
  const MeasurementTime begun = joints.newest()->time;
  ASSERT_TRUE(wait_until([&](const PlcView& view) {
    return believed(view) && joints.newest()->time - begun > std::chrono::seconds(1);
  }));
  travel = 3.0;
  ASSERT_TRUE(wait_until([](const PlcView& view) {
    return view.joint_trouble.find("wait for a re-acquire") != std::string::npos;
  }));
  EXPECT_NE(exchange.plc.get().standing & fault::plc_value, 0);
  server.set_command(kCommandReacquire);
  ASSERT_TRUE(wait_until(believed));
  exchange.joints.drain_into(joints);
  EXPECT_FALSE(joints.newest()->on_trial);
}

TEST_F(PlcThreadTest, WritesBeforeItReads) {
  plc.server().set_command(kCommandHold);
  GuardedThread runner(
      "plc", [this](std::stop_token stop) { thread.run(stop); },
      [](const std::string&, const std::string&) {}, [this] { exchange.plc_bell.ring(); });
  ASSERT_TRUE(plc.wait_for([](const WriteBlock& block) { return block.command_echo == kCommandHold; }, 0));
  EXPECT_EQ(plc.blocks().front().command_echo, 0)
      << "the first block went out before the command word was read";
  EXPECT_FALSE(plc.blocks().front().health);
}

TEST_F(PlcThreadTest, BeforeASuccessorTheLastWriteIsAUsualOneAndItsHeartbeatIsHandedOn) {
  {
    GuardedThread runner(
        "plc", [this](std::stop_token stop) { thread.run(stop); },
        [](const std::string&, const std::string&) {}, [this] { exchange.plc_bell.ring(); });
    ASSERT_TRUE(plc.wait_for([](const WriteBlock&) { return true; }, 0));
    thread.leave_without_farewell();
  }
  EXPECT_EQ(plc.blocks().back().state, State::starting);
  EXPECT_EQ(plc.blocks().back().heartbeat, thread.memory().heartbeat);
}

TEST_F(PlcThreadTest, AnEscapingExceptionLeavesHealthZeroAndStateStopped) {
  deliver(healthy_frame(1));
  std::string what;
  {
    GuardedThread runner(
        "plc", [this](std::stop_token stop) { thread.run(stop); },
        [&](const std::string&, const std::string& message) { what = message; },
        [this] { exchange.plc_bell.ring(); });
    ASSERT_TRUE(plc.wait_for([](const WriteBlock& block) { return block.health; }, 0));
    const std::size_t before = plc.blocks().size();
    log.fail_next();
    plc.server().set_fault(sim::PlcFault::out_of_range);  // something to log
    ASSERT_TRUE(plc.wait_for([](const WriteBlock& block) { return block.state == State::stopped; }, before));
  }
  EXPECT_EQ(what, "the log failed");
  EXPECT_FALSE(plc.blocks().back().health);
}

}  // namespace
}  // namespace hulltrack
