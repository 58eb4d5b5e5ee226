// A reload after which neither the new nor the old configuration can be put in force.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/socket.h>
#include <sys/syscall.h>
#include <unistd.h>

#include <atomic>
#include <cerrno>
#include <csignal>
#include <future>

#include "core/io/pcd_writer.hpp"
#include "daemon/service/service.hpp"
#include "tests/integration/service/loader_bench.hpp"
#include "tests/support/free_port.hpp"
#include "tests/support/temp_folder.hpp"

namespace {

std::atomic<bool> g_every_port_is_in_use = false;

}  // namespace

/// Takes the C library's place in this program: as if another program had taken every port.
extern "C" int bind(int fd, const sockaddr* address, socklen_t length) noexcept {
  if (g_every_port_is_in_use) {
    errno = EADDRINUSE;
    return -1;
  }
  return static_cast<int>(syscall(SYS_bind, fd, address, length));
}

namespace hulltrack {
namespace {

std::string toml(std::uint16_t lidar_port, std::uint16_t plc_port) {
  return "[plc]\nhost = \"127.0.0.1\"\nport = " + std::to_string(plc_port) +
         "\n[[lidar]]\nmodel = \"velodyne_vlp16\"\nbind = \"127.0.0.1\"\nport = " +
         std::to_string(lidar_port) +
         "\nmount = { xyz = [0.2, -0.3, 0.5], rpy_deg = [35.0, 20.0, 10.0] }\n[hull]\nmap = \"room.pcd\"\n";
}

TEST(ReloadFailure, WithNothingToFallBackToTheRegistersEndAtHealthZero) {
  Signals signals;  // before any other thread
  const test::TempFolder folder;
  CyclingPlc plc;
  const std::uint16_t lidar_port = free_port(SOCK_DGRAM);
  const RoomLidar lidar(lidar_port);
  ASSERT_TRUE(write_pcd(folder.path() / "room.pcd", RoomLidar::map()));
  const auto config = folder.file("hulltrackd.toml", toml(lidar_port, plc.server().port()));
  SyslogSink log({}, true);
  Service service({.config_file = config, .reader = {.program = HULLTRACKD_PROGRAM}}, signals, log);
  auto end = std::async(std::launch::async, [&] { return service.run(); });

  const auto healthy = plc.wait_for([](const WriteBlock& block) { return block.health; }, 0);
  if (!healthy) {
    ASSERT_EQ(kill(getpid(), SIGTERM), 0);
    end.get();
    return judge_missing_health(plc);
  }
  g_every_port_is_in_use = true;
  ASSERT_EQ(kill(getpid(), SIGHUP), 0);
  EXPECT_THROW(end.get(), std::runtime_error);
  g_every_port_is_in_use = false;

  const std::vector<WriteBlock> blocks = plc.blocks();
  const WriteBlock& last = blocks.back();
  EXPECT_FALSE(last.health);
  EXPECT_EQ(last.state, State::stopped);
  const WriteBlock& before = blocks[blocks.size() - 2];
  EXPECT_EQ(last.heartbeat, static_cast<std::uint16_t>(before.heartbeat + 1));
  EXPECT_EQ(last.x_m, before.x_m) << "the pose stays, its age grows";
  EXPECT_GT(last.age_ms, before.age_ms);
}

}  // namespace
}  // namespace hulltrack
