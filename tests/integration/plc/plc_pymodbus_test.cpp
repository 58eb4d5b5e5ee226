// Against a Modbus server that is not libmodbus and packs its registers with Python's struct.
#include <gtest/gtest.h>

#include <sstream>

#include "tests/integration/plc/plc_bench_setup.hpp"
#include "tests/support/pymodbus_peer.hpp"

namespace hulltrack {
namespace {

constexpr double kTravel = 123.456, kSlew = -30.125, kLuff = 7.25;

struct Case {
  WordOrder order;
  const char* name;
};
constexpr std::array kOrders{Case{WordOrder::abcd, "ABCD"}, Case{WordOrder::cdab, "CDAB"},
                             Case{WordOrder::badc, "BADC"}, Case{WordOrder::dcba, "DCBA"}};

WriteBlock sample_block() {
  return {.health = true,
          .state = State::tracking,
          .faults = 0x8001,
          .frame = 0x01234567,
          .x_m = 1.5,
          .y_m = -0.25,
          .z_m = 0.125,
          .roll_deg = 0.5,
          .pitch_deg = -0.375,
          .yaw_deg = 2.25,
          .q1_m = 0.0625,
          .mean_m = 0.5,
          .median_m = 0.25,
          .q3_m = 0.75,
          .rms_m = 1.25,
          .matched = 0x89ABCDEF,
          .age_ms = 47.5,
          .sigma_translation_m = 0.0625,
          .sigma_rotation_deg = 0.125,
          .processing_ms = 12.5,
          .command_echo = 2};
}

// The columns after the two times; 19088743 = 0x01234567, 2309737967 = 0x89ABCDEF.
constexpr const char* kSampleRow =
    "1,1,1,32769,19088743,1.5,-0.25,0.125,0.5,-0.375,2.25,0.0625,0.5,0.25,0.75,1.25,2309737967,47.5,0.0625,0."
    "125,"
    "12.5,2,1";

std::string without_times(const std::string& row) { return row.substr(row.find(',', row.find(',') + 1) + 1); }

void exchange_with_pymodbus(const Case& order, bool integers) {
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

  const PlcWrite write = client.write(sample_block());
  ASSERT_TRUE(write.ok()) << write.message;
  EXPECT_EQ(without_times(peer.read_line()), kSampleRow);
  EXPECT_EQ(client.connections(), 1U);
}

class PlcPymodbus : public testing::TestWithParam<Case> {};

TEST_P(PlcPymodbus, ReadsAndWritesFloat32) { exchange_with_pymodbus(GetParam(), false); }
TEST_P(PlcPymodbus, ReadsAndWritesInt32) { exchange_with_pymodbus(GetParam(), true); }

INSTANTIATE_TEST_SUITE_P(EveryWordOrder, PlcPymodbus, testing::ValuesIn(kOrders),
                         [](const testing::TestParamInfo<Case>& test) { return test.param.name; });

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
