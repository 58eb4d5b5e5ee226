// The service's threads against a PLC and a LiDAR on loopback, in this process.
#include "daemon/service/session.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <netinet/in.h>
#include <sys/socket.h>
#include <unistd.h>

#include <cstdio>
#include <string_view>

#include "daemon/service/farewell.hpp"
#include "tests/integration/service/loader_bench.hpp"
#include "tests/support/free_port.hpp"
#include "tests/support/recording_log.hpp"

namespace hulltrack {
namespace {

bool healthy(const WriteBlock& block) { return block.health; }

class SessionTest : public testing::Test {
 protected:
  static void fail(const std::string& thread, const std::string& what) {
    ADD_FAILURE() << thread << ": " << what;
  }

  void TearDown() override {
    session.reset();
    if (HasFailure()) {
      for (const RecordingLog::Line& line : log.lines) {
        std::printf("log: %s\n", line.text.c_str());
      }
    }
  }

  void start(const RegisterMemory& before = {}) {
    session = std::make_unique<Session>(room_service(lidar_port, plc_port), log, fail, before);
  }
  std::optional<WriteBlock> wait_for(const std::function<bool(const WriteBlock&)>& law) {
    return plc->wait_for(law);
  }
  /// The first write with the fault bit after what causes it.
  std::optional<WriteBlock> fault_after(const std::function<void()>& cause, Faults bit) {
    const std::size_t before = plc->blocks().size();
    cause();
    return plc->wait_for([bit](const WriteBlock& block) { return (block.faults & bit) != 0; }, before);
  }
  std::optional<WriteBlock> fault_after(sim::PlcFault of_plc, int times, Faults bit) {
    return fault_after([&] { plc->server().set_fault(of_plc, times); }, bit);
  }

  void send_to_lidar_port(std::string_view bytes) const {
    const int fd = socket(AF_INET, SOCK_DGRAM | SOCK_CLOEXEC, 0);
    sockaddr_in to{};
    to.sin_family = AF_INET;
    to.sin_port = htons(lidar_port);
    to.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    EXPECT_EQ(sendto(fd, bytes.data(), bytes.size(), 0, reinterpret_cast<const sockaddr*>(&to), sizeof to),
              static_cast<ssize_t>(bytes.size()));
    close(fd);
  }

  /// Waits until `count` more writes have failed.
  bool wait_for_failed_writes(std::uint64_t count) {
    const auto deadline = std::chrono::steady_clock::now() + std::chrono::minutes(1);
    std::uint64_t failed = 0;
    while (failed < count && std::chrono::steady_clock::now() < deadline) {
      failed += session->take_figures().writes_failed;
      std::this_thread::yield();
    }
    return failed >= count;
  }

  RecordingLog log;
  std::uint16_t lidar_port = free_port(SOCK_DGRAM);
  RoomLidar lidar{lidar_port};
  std::unique_ptr<CyclingPlc> plc = std::make_unique<CyclingPlc>();
  std::uint16_t plc_port = plc->server().port();
  std::unique_ptr<Session> session;
};

// A session that tracks the room.
class TrackingSession : public SessionTest {
 protected:
  void SetUp() override {
    start();
    if (!wait_for(healthy)) {
      judge_missing_health(*plc);
    }
  }
};

TEST_F(TrackingSession, TracksARoomAndLeavesHealthZeroAndStateStopped) {
  const auto block = wait_for(healthy);
  ASSERT_TRUE(block);
  EXPECT_EQ(block->state, State::tracking);
  EXPECT_NEAR(block->x_m, 0.0, 0.05);
  EXPECT_NEAR(block->y_m, 0.0, 0.05);
  EXPECT_NEAR(block->z_m, 0.0, 0.05);
  EXPECT_GT(block->matched, 200U);
  session->end(Session::Ending::for_good);
  const WriteBlock last = plc->blocks().back();
  EXPECT_FALSE(last.health);
  EXPECT_EQ(last.state, State::stopped);
  EXPECT_GE(log.count("state tracking"), 1U);
  EXPECT_EQ(log.count("state stopped"), 1U);
}

TEST_F(SessionTest, HeartbeatGrowsByOneAtEveryWriteAlsoAcrossAReload) {
  RegisterMemory before;
  before.heartbeat = 65530;
  start(before);
  if (!wait_for(healthy)) {
    return judge_missing_health(*plc);
  }
  const RegisterMemory last = session->end(Session::Ending::for_reload);
  session.reset();
  start(last);
  ASSERT_TRUE(wait_for(healthy));
  session->end(Session::Ending::for_good);
  const auto blocks = plc->blocks();
  EXPECT_EQ(blocks.front().heartbeat, 65531);
  for (std::size_t i = 1; i < blocks.size(); ++i) {
    ASSERT_EQ(blocks[i].heartbeat, static_cast<std::uint16_t>(blocks[i - 1].heartbeat + 1));
    ASSERT_EQ(blocks[i].heartbeat, blocks[i].heartbeat_copy);
    ASSERT_EQ(blocks[i].health, blocks[i].state == State::tracking);
    ASSERT_EQ(blocks[i].state == State::stopped, i + 1 == blocks.size());
  }
}

TEST_F(TrackingSession, AReloadKeepsThePoseWithHealthZeroItsAgeGrowsAndFramesGoOn) {
  const RegisterMemory memory = session->end(Session::Ending::for_reload);
  session.reset();
  const auto old_blocks = plc->blocks();
  const WriteBlock last = old_blocks.back();
  start(memory);
  const auto again = plc->wait_for(healthy, old_blocks.size());
  ASSERT_TRUE(again);
  session.reset();
  const auto blocks = plc->blocks();
  double age = last.age_ms;
  std::size_t i = old_blocks.size();
  for (; !blocks[i].health; ++i) {
    ASSERT_EQ(blocks[i].frame, last.frame);
    ASSERT_EQ(blocks[i].x_m, last.x_m);
    ASSERT_EQ(blocks[i].yaw_deg, last.yaw_deg);
    ASSERT_EQ(blocks[i].sigma_translation_m, last.sigma_translation_m);
    ASSERT_GT(blocks[i].age_ms, age);
    age = blocks[i].age_ms;
  }
  EXPECT_GT(i, old_blocks.size()) << "health was 0 in between";
  EXPECT_EQ(blocks[old_blocks.size()].state, State::starting);
  EXPECT_GT(again->frame, last.frame);
}

TEST_F(TrackingSession, AFarewellThatFailsIsToldAsSuch) {
  plc.reset();
  session->end(Session::Ending::for_good);
  EXPECT_FALSE(session->farewell().ok());
  EXPECT_THAT(farewell_words(session->farewell()), testing::HasSubstr("may still say health 1"));
}

TEST_F(TrackingSession, ASilentLidarTakesTheHealthAndGivesItBack) {
  const auto silent = fault_after([this] { lidar.mute(true); }, fault::lidar_silent);
  ASSERT_TRUE(silent);
  EXPECT_FALSE(silent->health);
  EXPECT_EQ(silent->state, State::fault);
  lidar.mute(false);
  EXPECT_TRUE(wait_for(healthy));
  session.reset();
  EXPECT_GE(log.count("no usable packet"), 1U);
  EXPECT_GE(log.count("packets again"), 1U);
}

TEST_F(SessionTest, OneOfTwoLidarsUnpluggedIsNamedAndNoPoseIsReleasedUntilItIsBack) {
  const std::uint16_t second_port = free_port(SOCK_DGRAM);
  RoomLidar second(second_port);
  Prepared prepared = room_service(lidar_port, plc_port);
  prepared.config.lidars.push_back(prepared.config.lidars.front());
  prepared.config.lidars[1].name = "boom2";
  prepared.config.lidars[1].port = second_port;
  session = std::make_unique<Session>(prepared, log, fail);
  if (!wait_for(healthy)) {
    return judge_missing_health(*plc);
  }
  const auto silent = fault_after([&] { second.mute(true); }, fault::lidar_silent);
  ASSERT_TRUE(silent);
  const std::size_t unplugged = plc->blocks().size();
  EXPECT_FALSE(silent->health);
  EXPECT_EQ(silent->state, State::degraded) << "the other one goes on";
  const auto fresh = [&](const WriteBlock& block) { return block.q1_m != silent->q1_m; };
  for (int frames = 0; frames < 10; ++frames) {
    ASSERT_TRUE(wait_for(fresh)) << "its frames are still registered";
  }
  const std::size_t plugged_in = plc->blocks().size();
  second.mute(false);
  ASSERT_TRUE(wait_for(healthy));
  const auto blocks = plc->blocks();
  for (std::size_t i = unplugged; i < plugged_in; ++i) {
    EXPECT_FALSE(blocks[i].health) << i;
    EXPECT_EQ(blocks[i].state, State::degraded) << i;
  }
  session.reset();
  EXPECT_EQ(log.count("LiDAR boom2: no usable packet"), 1U);
  EXPECT_EQ(log.count("LiDAR boom2: packets again"), 1U);
  EXPECT_EQ(log.count("LiDAR boom: no usable packet"), 0U);
}

TEST_F(TrackingSession, AForeignSenderIsNamedAndChangesNothing) {
  RoomLidar foreign(lidar_port);
  ASSERT_TRUE(fault_after([&] { foreign.send_from(INADDR_LOOPBACK + 1); }, fault::foreign_packets));
  const auto block = wait_for(healthy);
  ASSERT_TRUE(block);
  EXPECT_NEAR(block->x_m, 0.0, 0.05);
  session.reset();
  EXPECT_GE(log.count("127.0.0.2:"), 1U);
}

TEST_F(SessionTest, PacketsOfAnotherModelAreToldAlthoughNoFrameComesOfThem) {
  Prepared other = room_service(lidar_port, plc_port);
  other.config.lidars.front().model = "velodyne_vlp32c";
  session = std::make_unique<Session>(other, log, fail);
  const auto told =
      wait_for([](const WriteBlock& block) { return (block.faults & fault::foreign_packets) != 0; });
  ASSERT_TRUE(told);
  EXPECT_EQ(told->state, State::starting);
  session.reset();
  EXPECT_GE(log.count("not those of a velodyne_vlp32c"), 1U);
}

TEST_F(TrackingSession, AMalformedPacketIsToldWhileTheLidarIsSilent) {
  ASSERT_TRUE(fault_after([this] { lidar.mute(true); }, fault::lidar_silent));
  const auto told =
      fault_after([this] { send_to_lidar_port("no packet of a LiDAR"); }, fault::foreign_packets);
  ASSERT_TRUE(told);
  EXPECT_NE(told->faults & fault::lidar_silent, 0);
}

TEST_F(SessionTest, StartsWithoutAPlcAndServesItOnceItIsThere) {
  plc.reset();
  start();
  plc = std::make_unique<CyclingPlc>(plc_port);
  if (!wait_for(healthy)) {
    return judge_missing_health(*plc);
  }
}

TEST_F(TrackingSession, ALostLinkIsToldAndMended) {
  ASSERT_TRUE(fault_after(sim::PlcFault::reset, 1, fault::plc_link_lost));
  EXPECT_TRUE(wait_for(healthy));
  ASSERT_TRUE(fault_after(sim::PlcFault::late_reply, 1, fault::plc_link_lost));
  EXPECT_TRUE(wait_for(healthy));
}

TEST_F(TrackingSession, APlcThatFallsSilentIsServedAgainWhenItSpeaks) {
  for (const sim::PlcFault fault :
       {sim::PlcFault::silent, sim::PlcFault::black_hole, sim::PlcFault::pool_full}) {
    plc->server().set_fault(fault);
    ASSERT_TRUE(wait_for_failed_writes(3));
    ASSERT_TRUE(fault_after([this] { plc->server().set_fault(sim::PlcFault::none); }, fault::plc_link_lost));
    ASSERT_TRUE(wait_for(healthy));
  }
  EXPECT_EQ(plc->server().most_connections(), 1) << "never more than one socket";
}

TEST_F(TrackingSession, AFloodFromTheRightAddressKeepsTheRhythm) {
  {
    std::vector<std::unique_ptr<RoomLidar>> flood;
    for (int copy = 0; copy < 5; ++copy) {
      flood.push_back(std::make_unique<RoomLidar>(lidar_port));
    }
    for (int frame = 0; frame < 10; ++frame) {
      ASSERT_TRUE(wait_for([](const WriteBlock& block) { return block.matched > 0; }));
    }
  }
  EXPECT_TRUE(wait_for(healthy));
}

TEST_F(TrackingSession, AFrozenPlcHeartbeatIsStaleData) {
  const auto stale =
      fault_after([this] { plc->server().set_fault(sim::PlcFault::frozen_heartbeat); }, fault::plc_stale);
  ASSERT_TRUE(stale);
  EXPECT_FALSE(stale->health);
  EXPECT_EQ(stale->state, State::fault);
  plc->server().set_fault(sim::PlcFault::none);
  EXPECT_TRUE(wait_for(healthy));
}

TEST_F(TrackingSession, AnImpossibleJointValueIsRefused) {
  ASSERT_TRUE(
      fault_after([this] { plc->server().set_fault(sim::PlcFault::out_of_range); }, fault::plc_value));
  EXPECT_TRUE(wait_for([](const WriteBlock& block) { return !block.health; }));
  plc->server().set_fault(sim::PlcFault::none);
  EXPECT_TRUE(wait_for(healthy));
}

TEST_F(TrackingSession, ObeysTheCommandWordAndEchoesIt) {
  plc->server().set_command(kCommandHold);
  const auto held = wait_for([](const WriteBlock& block) { return block.state == State::held; });
  ASSERT_TRUE(held);
  EXPECT_FALSE(held->health);
  EXPECT_EQ(held->command_echo, kCommandHold);
  plc->server().set_command(0);
  ASSERT_TRUE(wait_for(healthy));
  plc->server().set_command(kCommandReacquire);
  const auto acquiring = wait_for([](const WriteBlock& block) { return block.state == State::acquiring; });
  ASSERT_TRUE(acquiring);
  EXPECT_EQ(acquiring->command_echo, kCommandReacquire);
  EXPECT_TRUE(wait_for(healthy));
}

TEST_F(SessionTest, APortInUseIsOneClearLine) {
  start();
  try {
    Session second(room_service(lidar_port, plc_port), log, fail);
    FAIL() << "two services on one port";
  } catch (const std::runtime_error& error) {
    EXPECT_THAT(error.what(), testing::HasSubstr(std::to_string(lidar_port)));
  }
}

}  // namespace
}  // namespace hulltrack
