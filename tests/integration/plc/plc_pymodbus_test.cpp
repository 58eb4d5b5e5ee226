// Against a Modbus server that is not libmodbus and packs its registers with Python's struct.
#include <gtest/gtest.h>

#include <sstream>

#include "tests/integration/plc/plc_bench_setup.hpp"
#include "tests/support/pymodbus_peer.hpp"
#include "tests/support/register_vectors.hpp"

namespace hulltrack {
namespace {

constexpr double kTravel = 123.456, kSlew = -30.125, kLuff = 7.25;

/// The columns after the two times.
std::string without_times(const std::string& row) { return row.substr(row.find(',', row.find(',') + 1) + 1); }

void exchange_with_pymodbus(const test::NamedWordOrder& order, bool integers) {
  std::ostringstream joints;
  joints << kTravel << ',' << kSlew << ',' << kLuff;
  std::vector<std::string> arguments{"--joints=" + joints.str(),
                                     "--word-order",
                                     order.name,
                                     "--tail",
                                     "8",
                                     "--read-base",
                                     "300",
                                     "--write-base",
                                     "2000"};
  if (integers) {
    for (const char* argument : {"--read-type", "int32", "--read-scale", "0.001", "--encoding", "int32"}) {
      arguments.emplace_back(argument);
    }
  }
  PymodbusPeer peer(arguments);
  if (!peer.started())
    GTEST_SKIP() << "pymodbus_plc.py does not start; scripts/setup installs python3-pymodbus";

  PlcConfig config;
  config.host = "127.0.0.1";
  config.port = peer.port();
  config.response_timeout = kPatient;
  config.read.base = 300;
  config.read.word_order = order.order;
  config.read.heartbeat_tail = 8;
  config.write = {.base = 2000,
                  .word_order = order.order,
                  .encoding = integers ? WriteEncoding::int32_e4 : WriteEncoding::float32};
  if (integers) {
    for (JointRegister* joint : {&config.read.travel, &config.read.slew, &config.read.luff}) {
      joint->type = RegisterType::int32;
      joint->scale = 0.001;
    }
  }
  PlcClient client(config);
  const PlcPoll poll = client.poll();
  ASSERT_TRUE(poll.ok()) << poll.message;
  EXPECT_FLOAT_EQ(static_cast<float>(poll.reading.travel_m), static_cast<float>(kTravel));
  EXPECT_FLOAT_EQ(static_cast<float>(poll.reading.slew_deg), static_cast<float>(kSlew));
  EXPECT_FLOAT_EQ(static_cast<float>(poll.reading.luff_deg), static_cast<float>(kLuff));
  EXPECT_FALSE(poll.reading.torn);

  const PlcWrite write = client.write(test::sample_block());
  ASSERT_TRUE(write.ok()) << write.message;
  EXPECT_EQ(without_times(peer.read_line()), std::string("1,") + test::kSampleRow + ",1") << "heartbeat 1";
  EXPECT_EQ(client.connections(), 1U);
}

class PlcPymodbus : public testing::TestWithParam<test::NamedWordOrder> {};

TEST_P(PlcPymodbus, ReadsAndWritesFloat32) { exchange_with_pymodbus(GetParam(), false); }
TEST_P(PlcPymodbus, ReadsAndWritesInt32) { exchange_with_pymodbus(GetParam(), true); }

INSTANTIATE_TEST_SUITE_P(EveryWordOrder, PlcPymodbus, testing::ValuesIn(test::kWordOrders),
                         [](const testing::TestParamInfo<test::NamedWordOrder>& tested) {
                           return tested.param.name;
                         });

TEST(PlcPymodbusCycle, HeartbeatMovesAndCommandsArrive) {
  PymodbusPeer peer({"--cycle-ms", "0"});
  if (!peer.started())
    GTEST_SKIP() << "pymodbus_plc.py does not start; scripts/setup installs python3-pymodbus";
  PlcConfig config;
  config.host = "127.0.0.1";
  config.port = peer.port();
  config.response_timeout = kPatient;
  PlcClient client(config);
  EXPECT_TRUE(client.poll().fresh);
  EXPECT_TRUE(client.poll().fresh);
  peer.send_line("command 3");
  peer.send_line("joints 1.5,2.5,3.5");
  PlcPoll poll = client.poll();
  while (poll.ok() && poll.reading.travel_m != 1.5) poll = client.poll();  // the line is on its way
  ASSERT_TRUE(poll.ok()) << poll.message;
  EXPECT_EQ(poll.reading.luff_deg, 3.5);
  EXPECT_EQ(poll.reading.command, 3);
}

}  // namespace
}  // namespace hulltrack
