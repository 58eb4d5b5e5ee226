// The link when all is well, and what may be configured.
#include <fcntl.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/resource.h>
#include <sys/select.h>
#include <unistd.h>

#include <mutex>
#include <stdexcept>
#include <vector>

#include "tests/integration/plc/plc_bench_setup.hpp"

namespace hulltrack {
namespace {

using sim::PlcServer;
using testing::HasSubstr;

TEST(PlcLink, AReadingIsWhatThePlcShowsInItsCycle) {
  PlcServer server({});
  server.set_joints(12.5, -30.0, 7.25);
  server.set_command(3);
  PlcClient client(client_config(server));
  const SteadyTime before = std::chrono::steady_clock::now();
  const PlcPoll poll = client.poll();
  const SteadyTime after = std::chrono::steady_clock::now();
  ASSERT_TRUE(poll.ok()) << poll.message;
  EXPECT_EQ(poll.reading.travel_m, 12.5);
  EXPECT_EQ(poll.reading.slew_deg, -30.0);
  EXPECT_EQ(poll.reading.luff_deg, 7.25);
  EXPECT_EQ(poll.reading.command, 3);
  EXPECT_EQ(poll.reading.heartbeat, 1);
  EXPECT_LE(before, poll.requested);
  EXPECT_LE(poll.requested, poll.stamp());
  EXPECT_LE(poll.stamp(), poll.answered);
  EXPECT_LE(poll.answered, after);
}

TEST(PlcLink, AWriteArrivesWholeWithTheNextHeartbeatAndItsCopy) {
  PlcServer server({});
  std::mutex mutex;
  std::vector<std::uint16_t> heartbeats;
  server.on_write([&](const sim::PlcWriteRecord& record) {
    const std::lock_guard lock(mutex);
    heartbeats.push_back(record.block.heartbeat);
  });
  PlcClient client(client_config(server));
  WriteBlock block{.health = true, .state = State::tracking, .frame = 70000, .x_m = 0.25, .age_ms = 40.0};
  for (int i = 0; i < 3; ++i) ASSERT_TRUE(client.write(block).ok());
  ASSERT_TRUE(server.wait_for_writes(3, kPatient));
  block.heartbeat = block.heartbeat_copy = 3;
  EXPECT_EQ(server.last_write()->block, block);
  EXPECT_EQ(server.last_write()->number, 3U);
  const std::lock_guard lock(mutex);
  EXPECT_THAT(heartbeats, testing::ElementsAre(1, 2, 3));
  EXPECT_EQ(client.connections(), 1U);
}

TEST(PlcLink, AHostNameIsLookedUp) {
  PlcServer server({});
  PlcConfig config = client_config(server);
  config.host = "localhost";  // may be ::1 first, where nobody listens
  TestClock clock;
  PlcClient client(config, clock_of(clock));
  EXPECT_LT(polls_lost(client, clock), 100);
}

TEST(PlcLink, AnUnknownHostIsAnOutcomeThatNamesIt) {
  PlcConfig config;
  config.host = "plc.invalid";  // RFC 2606: never exists
  PlcClient client(config);
  const PlcPoll poll = client.poll();
  EXPECT_EQ(poll.outcome, LinkOutcome::unreachable);
  EXPECT_THAT(poll.message, HasSubstr("plc.invalid"));
}

TEST(PlcLink, AnIpv6LiteralIsAnAddress) {
  PlcServer server({});  // listens on IPv4 only
  PlcConfig config = client_config(server);
  config.host = "::1";
  PlcClient client(config);
  const PlcPoll poll = client.poll();
  EXPECT_EQ(poll.outcome, LinkOutcome::unreachable);
  EXPECT_THAT(poll.message, HasSubstr("no connection: Connection refused"));
}

TEST(PlcLink, ASocketBeyondSelectIsRefused) {
  rlimit limit{};
  ASSERT_EQ(getrlimit(RLIMIT_NOFILE, &limit), 0);
  const rlimit old = limit;
  limit.rlim_cur = FD_SETSIZE + 64;
  if (limit.rlim_cur > limit.rlim_max || setrlimit(RLIMIT_NOFILE, &limit) != 0) {
    GTEST_SKIP() << "this process may not open more than " << limit.rlim_max << " files";
  }
  PlcServer server({});
  TestClock clock;
  PlcClient client(client_config(server), clock_of(clock));
  std::vector<int> files;
  while (files.empty() || files.back() < FD_SETSIZE) files.push_back(open("/dev/null", O_RDONLY | O_CLOEXEC));
  const PlcPoll poll = client.poll();
  EXPECT_EQ(poll.outcome, LinkOutcome::unreachable);
  EXPECT_THAT(poll.message, HasSubstr("beyond select()"));
  for (const int file : files) close(file);
  EXPECT_LT(polls_lost(client, clock), 100);
  setrlimit(RLIMIT_NOFILE, &old);
}

TEST(PlcLink, SettingsThatCannotWorkAreRefusedAtOnce) {
  PlcConfig config;
  config.host = "127.0.0.1";
  config.unit_id = 250;
  EXPECT_THROW(PlcClient{config}, std::invalid_argument);
  config.unit_id = 1;
  config.read.luff.offset = 124;
  EXPECT_THROW(PlcClient{config}, std::invalid_argument);
  config.read.luff.offset = 123;
  EXPECT_NO_THROW(PlcClient{config});
}

TEST(PlcServer, APortInUseIsAClearError) {
  PlcServer first({});
  try {
    PlcServer second({.port = first.port()});
    FAIL() << "two servers on one port";
  } catch (const std::runtime_error& error) {
    EXPECT_THAT(error.what(), HasSubstr(std::to_string(first.port())));
  }
}

}  // namespace
}  // namespace hulltrack
