// The last write of a service: what it does to reach the PLC, and what is said when it does not.
#include "daemon/service/farewell.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/socket.h>

#include "tests/integration/service/loader_bench.hpp"
#include "tests/support/free_port.hpp"

namespace hulltrack {
namespace {

PlcConfig plc_on(std::uint16_t port) { return room_service(1, port).config.plc; }

WriteBlock healthy_block() {
  WriteBlock block;
  block.health = true;
  block.state = State::tracking;
  return block;
}

void expect_stopped(const WriteBlock& block) {
  EXPECT_FALSE(block.health);
  EXPECT_EQ(block.state, State::stopped);
}

TEST(Farewell, IsTriedAgainWhenTheConnectionIsLost) {
  CyclingPlc plc;
  PlcClient client(plc_on(plc.server().port()));
  ASSERT_TRUE(client.write(healthy_block()).ok());
  plc.server().set_fault(sim::PlcFault::reset, 1);
  const PlcWrite written = write_farewell(client, healthy_block());
  EXPECT_TRUE(written.ok()) << written.message;
  EXPECT_THAT(farewell_words(written), testing::HasSubstr("sees health 0"));
  expect_stopped(plc.blocks().back());
}

TEST(Farewell, DoesNotBackOff) {
  const std::uint16_t port = free_port(SOCK_STREAM);
  PlcClient client(plc_on(port), [] { return SteadyTime(std::chrono::hours(1)); });  // no back-off ever ends
  while (client.write(healthy_block()).outcome != LinkOutcome::waiting) {
  }
  CyclingPlc plc(port);
  const PlcWrite written = write_farewell(client, healthy_block());
  EXPECT_TRUE(written.ok()) << written.message;
  expect_stopped(plc.blocks().back());
}

TEST(Farewell, ThatFailsIsToldWithWhatItMeans) {
  PlcClient client(plc_on(free_port(SOCK_STREAM)));
  const PlcWrite written = write_farewell(client, healthy_block());
  EXPECT_FALSE(written.ok());
  EXPECT_THAT(farewell_words(written),
              testing::AllOf(testing::HasSubstr("could not be told (no connection"),
                             testing::HasSubstr("may still say health 1"), testing::HasSubstr("heartbeat")));
}

}  // namespace
}  // namespace hulltrack
