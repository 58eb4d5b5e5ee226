// What is printed reads back equal, and the defaults are those that the manual promises.
#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "daemon/config/key_table.hpp"
#include "daemon/config/nearest_name.hpp"
#include "daemon/config/read_config.hpp"
#include "daemon/config/value_text.hpp"

namespace hulltrack {
namespace {

Config usable_config() {
  Config config;
  config.plc.host = "10.0.0.1";
  config.map_file = "/maps/h.pcd";
  config.lidars.resize(1);
  config.lidars[0].model = "velodyne_vlp16";
  return config;
}

/// Every value of the configuration as text, in the order of the table.
std::vector<std::string> values_of(Config config) {
  std::vector<std::string> values;
  const auto add = [&](const std::vector<Section>& sections) {
    for (const Section& section : sections) {
      for (const Key& key : section.keys) {
        values.push_back(section.name + '.' + key.name + " = " + toml_text(key.get()));
      }
    }
  };
  add(config_sections(config));
  for (LidarConfig& lidar : config.lidars) {
    add(lidar_sections(lidar, {}));
  }
  return values;
}

TEST(PrintConfig, DefaultsReadBackEqual) {
  const Config config = usable_config();
  const auto reading = parse_config(print_config(config), "/elsewhere/a.toml", {});
  ASSERT_TRUE(reading.config) << to_string(reading.problems.at(0));
  EXPECT_EQ(values_of(*reading.config), values_of(config));
}

TEST(PrintConfig, AwkwardValuesReadBackEqual) {
  Config config = usable_config();
  config.plc.read.slew.scale = 360.0 / 131072.0;
  config.plc.read.slew.bias = 1.0 / 3.0;
  config.plc.latency = std::chrono::microseconds(1234);
  config.plc.write.encoding = WriteEncoding::int32_e4;
  config.machine.luff = pose_from_xyz_rpy_deg({1e-9, -0.1, 100.25}, {-179.5, 0.001, 33.3});
  config.lidars[0].mount = pose_from_xyz_rpy_deg({0.3, 0.0, 0.0}, {12.34567, -45.0, 90.0});
  config.lidars[0].name = "left \"boom\" \\ \u00e9";
  config.lidars[0].exclude = {{-0.1, 0.2, 1.0 / 3.0, 4.0, 5.0, 6.0}, {0.0, 0.0, 0.0, 1.0, 1.0, 1.0}};
  config.lidars.push_back(config.lidars[0]);
  config.lidars[1].name = "right";
  config.lidars[1].port = 2369;
  config.map_file = "/maps/tab\there.pcd";
  config.tracker.hull.region = Box{{-0.1F, 0.2F, 0.3F}, {1.1F, 2.2F, 3.3F}};
  config.tracker.hull.max_speed = 0.123456789012345;
  config.tracker.registration.rotation_epsilon = radians(0.07);
  config.tracker.registration.method = RegistrationMethod::point_to_point;
  config.framing.framing = Framing::revolution;
  config.log.level = LogLevel::error;

  const std::string text = print_config(config);
  const auto reading = parse_config(text, "/elsewhere/a.toml", {});
  ASSERT_TRUE(reading.config) << to_string(reading.problems.at(0));
  EXPECT_EQ(values_of(*reading.config), values_of(config));
  EXPECT_EQ(print_config(*reading.config), text);
  EXPECT_EQ(reading.config->plc.read.slew.scale, config.plc.read.slew.scale);
  EXPECT_TRUE(reading.config->machine.luff.isApprox(config.machine.luff, 1e-12));
  EXPECT_TRUE(reading.config->lidars[0].mount.isApprox(config.lidars[0].mount, 1e-12));
  EXPECT_EQ(reading.config->tracker.hull.region->max, config.tracker.hull.region->max);
}

// The contract's values, written down a second time by hand.
TEST(Config, DefaultsAreTheContracts) {
  const std::vector<std::string> expected = {R"(plc.host = "10.0.0.1")",
                                             "plc.port = 502",
                                             "plc.unit_id = 1",
                                             "plc.poll_period_ms = 20",
                                             "plc.write_period_ms = 100",
                                             "plc.response_timeout_ms = 100",
                                             "plc.heartbeat_timeout_ms = 500",
                                             "plc.latency_ms = 0.0",
                                             "plc.read.base = 0",
                                             R"(plc.read.word_order = "ABCD")",
                                             "plc.read.heartbeat = 6",
                                             "plc.read.heartbeat_tail = -1",
                                             "plc.read.command = 7",
                                             "plc.read.travel.offset = 0",
                                             R"(plc.read.travel.type = "float32")",
                                             "plc.read.travel.scale = 1.0",
                                             "plc.read.travel.bias = 0.0",
                                             "plc.read.travel.sign = 1",
                                             "plc.read.travel.min = -500.0",
                                             "plc.read.travel.max = 500.0",
                                             "plc.read.travel.max_rate = 1.0",
                                             "plc.read.slew.offset = 2",
                                             R"(plc.read.slew.type = "float32")",
                                             "plc.read.slew.scale = 1.0",
                                             "plc.read.slew.bias = 0.0",
                                             "plc.read.slew.sign = 1",
                                             "plc.read.slew.min = -360.0",
                                             "plc.read.slew.max = 360.0",
                                             "plc.read.slew.max_rate = 3.0",
                                             "plc.read.luff.offset = 4",
                                             R"(plc.read.luff.type = "float32")",
                                             "plc.read.luff.scale = 1.0",
                                             "plc.read.luff.bias = 0.0",
                                             "plc.read.luff.sign = 1",
                                             "plc.read.luff.min = -90.0",
                                             "plc.read.luff.max = 90.0",
                                             "plc.read.luff.max_rate = 3.0",
                                             "plc.write.base = 100",
                                             R"(plc.write.word_order = "ABCD")",
                                             R"(plc.write.encoding = "float32")",
                                             "machine.slew.xyz = [0.0, 0.0, 0.0]",
                                             "machine.slew.rpy_deg = [0.0, 0.0, 0.0]",
                                             "machine.luff.xyz = [0.0, 0.0, 0.0]",
                                             "machine.luff.rpy_deg = [0.0, 0.0, 0.0]",
                                             R"(hull.map = "/maps/h.pcd")",
                                             "hull.reference_point = [0.0, 0.0, 0.0]",
                                             "hull.region = []",
                                             "hull.envelope = [-15.0, -2.0, -10.0, 15.0, 2.0, 10.0]",
                                             "hull.max_speed = 0.3",
                                             "hull.max_heel = 4.0",
                                             "hull.max_trim = 2.0",
                                             "hull.max_yaw = 3.5",
                                             R"(quay.height = "learn")",
                                             R"(quay.slope = "learn")",
                                             R"(quay.map = "")",
                                             R"(tracking.framing = "period")",
                                             "tracking.frame_rate_hz = 10.0",
                                             "tracking.voxel_size = 0.5",
                                             "tracking.max_correspondence_distance = 0.3",
                                             "tracking.max_iterations = 50",
                                             "tracking.translation_epsilon = 0.001",
                                             "tracking.rotation_epsilon_deg = 0.1",
                                             R"(tracking.method = "auto")",
                                             "health.q1_ratio_healthy = 1.5",
                                             "health.q1_ratio_lost = 3.0",
                                             "health.q1_healthy = 0.0",
                                             "health.q1_lost = 0.0",
                                             "health.metric_range = 25.0",
                                             "health.min_matched = 200",
                                             "health.recover_frames = 5",
                                             "health.max_age_ms = 500",
                                             R"(log.ident = "hulltrackd")",
                                             R"(log.facility = "daemon")",
                                             R"(log.level = "info")",
                                             R"(lidar.name = "boom")",
                                             R"(lidar.model = "velodyne_vlp16")",
                                             R"(lidar.bind = "0.0.0.0")",
                                             "lidar.port = 2368",
                                             "lidar.information_port = 0",
                                             R"(lidar.source = "")",
                                             R"(lidar.multicast = "")",
                                             R"(lidar.calibration = "")",
                                             "lidar.min_range = 1.0",
                                             "lidar.max_range = 120.0",
                                             "lidar.timeout_ms = 500",
                                             R"(lidar.time_source = "receive")",
                                             "lidar.firing_correction = true",
                                             "lidar.exclude = []",
                                             "lidar.mount.xyz = [0.0, 0.0, 0.0]",
                                             "lidar.mount.rpy_deg = [0.0, 0.0, 0.0]"};
  EXPECT_EQ(values_of(usable_config()), expected);
}

TEST(NearestName, CountsInsertionsDeletionsReplacementsAndSwaps) {
  EXPECT_EQ(edit_distance("", "abc"), 3U);
  EXPECT_EQ(edit_distance("port", "port"), 0U);
  EXPECT_EQ(edit_distance("prot", "port"), 1U);
  EXPECT_EQ(edit_distance("kitten", "sitting"), 3U);
  EXPECT_EQ(edit_distance("ca", "abc"), 3U) << "a swapped pair is not edited again";
}

TEST(NearestName, SaysNothingWhenNothingIsNear) {
  EXPECT_EQ(nearest_name("prot", {"host", "port"}), "port");
  EXPECT_EQ(nearest_name("colour", {"host", "port"}), std::nullopt);
  EXPECT_EQ(nearest_name(std::string(100'000, 'x'), {"host"}), std::nullopt);
}

}  // namespace
}  // namespace hulltrack
