// What the reader accepts, and what it says about each kind of error: file, line, key, what is allowed.
#include "daemon/config/read_config.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <numbers>
#include <string>
#include <vector>

#include "tests/support/temp_folder.hpp"

namespace hulltrack {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::StartsWith;

const std::vector<LidarModel> kModels = {{.name = "velodyne_vlp16", .port = 2368},
                                         {.name = "velodyne_vlp32c", .port = 2368},
                                         {.name = "ouster_os", .port = 7502}};

constexpr const char* kLeast =
    "[plc]\nhost = \"plc.example\"\n[[lidar]]\nmodel = \"velodyne_vlp16\"\n[hull]\nmap = \"hull.pcd\"\n";

ConfigReading parse(const std::string& text) { return parse_config(text, "/site/a.toml", kModels); }

std::vector<std::string> problems(const std::string& text) {
  std::vector<std::string> lines;
  for (const Problem& problem : parse(text).problems) {
    lines.push_back(to_string(problem));
  }
  return lines;
}

TEST(ReadConfig, LettersOfAnyLanguageMayStandInStringsAndComments) {
  const ConfigReading reading = parse(
      "\xEF\xBB\xBF# K\xC3\xBC, \"3\"\n[plc]\nhost = \"plc.example\"\n[[lidar]]\nmodel = \"velodyne_vlp16\"\n"
      "[hull]\nmap = \"\"\"\\\n  k\xC3\xBC.pcd\"\"\" # \xC3\xBC\n");
  ASSERT_TRUE(reading.problems.empty()) << to_string(reading.problems.front());
  EXPECT_EQ(reading.config->map_file, "/site/k\xC3\xBC.pcd");
}

TEST(ReadConfig, TheRequiredKeysAreEnough) {
  const auto reading = parse(kLeast);
  ASSERT_TRUE(reading.config) << ::testing::PrintToString(problems(kLeast));
  EXPECT_EQ(reading.config->plc.host, "plc.example");
  EXPECT_EQ(reading.config->lidars.at(0).model, "velodyne_vlp16");
  EXPECT_EQ(reading.config->map_file, "/site/hull.pcd");
}

TEST(ReadConfig, EveryValueArrivesInTheUnitsOfTheConfig) {
  const auto reading = parse(R"([plc]
host = "10.0.0.1"
port = 1502
unit_id = 255
poll_period_ms = 10
write_period_ms = 50
response_timeout_ms = 40
heartbeat_timeout_ms = 0
latency_ms = 2.5
[plc.read]
base = 40
word_order = "CDAB"
travel = { offset = 10, type = "int32", scale = 0.001, bias = -3, sign = -1, min = 0, max = 250, max_rate = 0.5 }
luff = { offset = 7, type = "uint16" }
heartbeat_tail = 20
command = -1
[plc.write]
base = 400
word_order = "DCBA"
encoding = "int32"
[machine]
slew = { xyz = [1, 2.5, -3], rpy_deg = [0, 0, 90] }
[[lidar]]
name = "left boom"
model = "velodyne_vlp32c"
bind = "127.0.0.1"
port = 2369
source = "192.168.1.201"
multicast = "239.1.2.3"
calibration = "sub/a.csv"
mount = { xyz = [0, 0, 1], rpy_deg = [0, 90, 0] }
min_range = 0.5
max_range = 90
timeout_ms = 300
time_source = "sensor"
firing_correction = false
exclude = [[0, 1, 2, 3, 4, 5], [-1, -1, -1, 1, 1, 1]]
[hull]
map = "../maps/h.ply"
reference_point = [10, 20, 30]
region = [-1, -2, -3, 1, 2, 3]
envelope = [-1, -1, -1, 1, 1, 1]
max_speed = 0.1
max_heel = 5
max_trim = 2.5
max_yaw = 1
[quay]
height = -0.15
slope = [0.1, -0.6]
map = "../maps/quay.pcd"
[tracking]
framing = "revolution"
frame_rate_hz = 20
voxel_size = 0.4
max_correspondence_distance = 0.5
max_iterations = 30
translation_epsilon = 0.002
rotation_epsilon_deg = 0.2
method = "point_to_point"
[health]
q1_ratio_healthy = 1.25
q1_ratio_lost = 2.5
q1_healthy = 0.2
q1_lost = 0.3
metric_range = 40
min_matched = 100
recover_frames = 7
max_age_ms = 400
[log]
ident = "hull-2"
facility = "local3"
level = "debug"
)");
  ASSERT_TRUE(reading.config) << to_string(reading.problems.at(0));
  const Config& c = *reading.config;
  EXPECT_EQ(c.plc.port, 1502);
  EXPECT_EQ(c.plc.unit_id, 255);
  EXPECT_EQ(c.plc.poll_period, std::chrono::milliseconds(10));
  EXPECT_EQ(c.plc.write_period, std::chrono::milliseconds(50));
  EXPECT_EQ(c.plc.response_timeout, std::chrono::milliseconds(40));
  EXPECT_EQ(c.plc.heartbeat_timeout, Nanoseconds{0});
  EXPECT_EQ(c.plc.latency, std::chrono::microseconds(2500));
  EXPECT_EQ(c.plc.read.base, 40);
  EXPECT_EQ(c.plc.read.word_order, WordOrder::cdab);
  EXPECT_EQ(c.plc.read.travel.offset, 10);
  EXPECT_EQ(c.plc.read.travel.type, RegisterType::int32);
  EXPECT_EQ(c.plc.read.travel.scale, 0.001);
  EXPECT_EQ(c.plc.read.travel.bias, -3.0);
  EXPECT_EQ(c.plc.read.travel.sign, -1);
  EXPECT_EQ(c.plc.read.travel.min, 0.0);
  EXPECT_EQ(c.plc.read.travel.max, 250.0);
  EXPECT_EQ(c.plc.read.travel.max_rate, 0.5);
  EXPECT_EQ(c.plc.read.luff.offset, 7);
  EXPECT_EQ(c.plc.read.luff.type, RegisterType::uint16);
  EXPECT_EQ(c.plc.read.luff.min, -90.0) << "keys left out of an inline table keep their defaults";
  EXPECT_EQ(c.plc.read.heartbeat_tail, 20);
  EXPECT_EQ(c.plc.read.command, -1);
  EXPECT_EQ(c.plc.write.base, 400);
  EXPECT_EQ(c.plc.write.word_order, WordOrder::dcba);
  EXPECT_EQ(c.plc.write.encoding, WriteEncoding::int32_e4);
  const Pose slew = pose_from_xyz_rpy_deg({1.0, 2.5, -3.0}, {0.0, 0.0, 90.0});
  EXPECT_TRUE(c.machine.slew.isApprox(slew, 1e-12));
  EXPECT_TRUE(c.machine.luff.isApprox(Pose::Identity(), 0.0));
  const LidarConfig& lidar = c.lidars.at(0);
  EXPECT_EQ(lidar.name, "left boom");
  EXPECT_EQ(lidar.bind, "127.0.0.1");
  EXPECT_EQ(lidar.port, 2369);
  EXPECT_EQ(lidar.source, "192.168.1.201");
  EXPECT_EQ(lidar.multicast, "239.1.2.3");
  EXPECT_EQ(lidar.calibration, "/site/sub/a.csv");
  EXPECT_TRUE(lidar.mount.isApprox(pose_from_xyz_rpy_deg({0.0, 0.0, 1.0}, {0.0, 90.0, 0.0}), 1e-12));
  EXPECT_EQ(lidar.min_range, 0.5);
  EXPECT_EQ(lidar.max_range, 90.0);
  EXPECT_EQ(lidar.timeout, std::chrono::milliseconds(300));
  EXPECT_EQ(lidar.time_source, TimeSource::sensor);
  EXPECT_FALSE(lidar.firing_correction);
  ASSERT_EQ(lidar.exclude.size(), 2U);
  EXPECT_EQ(lidar.exclude[0], (std::array<double, 6>{0, 1, 2, 3, 4, 5}));
  EXPECT_EQ(c.map_file, "/maps/h.ply");
  EXPECT_EQ(c.tracker.hull.reference_point, Eigen::Vector3d(10, 20, 30));
  ASSERT_TRUE(c.tracker.hull.region);
  EXPECT_EQ(c.tracker.hull.region->min, Point(-1, -2, -3));
  EXPECT_EQ(c.tracker.hull.region->max, Point(1, 2, 3));
  EXPECT_EQ(c.tracker.hull.envelope.max, Point(1, 1, 1));
  EXPECT_EQ(c.tracker.hull.max_speed, 0.1);
  EXPECT_DOUBLE_EQ(c.tracker.hull.max_heel, radians(5.0));
  EXPECT_DOUBLE_EQ(c.tracker.hull.max_trim, radians(2.5));
  EXPECT_DOUBLE_EQ(c.tracker.hull.max_yaw, radians(1.0));
  EXPECT_EQ(c.tracker.quay.height, -0.15);
  EXPECT_TRUE(c.tracker.quay.top_is_witness);
  ASSERT_TRUE(c.tracker.quay.slope);
  EXPECT_DOUBLE_EQ(c.tracker.quay.slope->y(), radians(-0.6));
  EXPECT_EQ(c.quay_file, "/maps/quay.pcd");
  EXPECT_EQ(c.framing.framing, Framing::revolution);
  EXPECT_EQ(c.framing.frame_rate_hz, 20.0);
  EXPECT_EQ(c.tracker.registration.voxel_size, 0.4);
  EXPECT_EQ(c.tracker.registration.max_correspondence_distance, 0.5);
  EXPECT_EQ(c.tracker.registration.max_iterations, 30);
  EXPECT_EQ(c.tracker.registration.translation_epsilon, 0.002);
  EXPECT_DOUBLE_EQ(c.tracker.registration.rotation_epsilon, 0.2 * std::numbers::pi / 180.0);
  EXPECT_EQ(c.tracker.registration.method, RegistrationMethod::point_to_point);
  EXPECT_EQ(c.tracker.health.q1_ratio_healthy, 1.25);
  EXPECT_EQ(c.tracker.health.q1_ratio_lost, 2.5);
  EXPECT_EQ(c.tracker.health.q1_healthy, 0.2);
  EXPECT_EQ(c.tracker.health.q1_lost, 0.3);
  EXPECT_EQ(c.tracker.health.metric_range, 40.0);
  EXPECT_EQ(c.tracker.health.min_matched, 100);
  EXPECT_EQ(c.tracker.health.recover_frames, 7);
  EXPECT_EQ(c.tracker.health.max_age, std::chrono::milliseconds(400));
  EXPECT_EQ(c.log.ident, "hull-2");
  EXPECT_EQ(c.log.facility, "local3");
  EXPECT_EQ(c.log.level, LogLevel::debug);
}

// Texts in which the lines under test come first, and the rest is good.
const std::string kPlc = "[plc]\nhost = \"p\"\n";
const std::string kLidar = "[[lidar]]\nmodel = \"velodyne_vlp16\"\n";
const std::string kHull = "[hull]\nmap = \"m.pcd\"\n";
std::string other(const std::string& text) { return text + kPlc + kLidar + kHull; }
std::string plc(const std::string& keys) { return "[plc]\n" + keys + "host = \"p\"\n" + kLidar + kHull; }
std::string read(const std::string& keys) { return "[plc.read]\n" + keys + kPlc + kLidar + kHull; }
std::string hull(const std::string& keys) { return "[hull]\n" + keys + "map = \"m.pcd\"\n" + kPlc + kLidar; }
std::string lidar(const std::string& keys) {
  return "[[lidar]]\n" + keys + "model = \"ouster_os\"\n" + kPlc + kHull;
}
std::string two_lidars(const std::string& first, const std::string& second) {
  return "[[lidar]]\nmodel = \"ouster_os\"\n" + first + "[[lidar]]\nmodel = \"ouster_os\"\n" + second + kPlc +
         kHull;
}

struct Wrong {
  const char* name;
  std::string text;
  const char* place;  // ":LINE: KEY"
  const char* says;
};

class WrongConfig : public ::testing::TestWithParam<Wrong> {};

TEST_P(WrongConfig, IsRefusedNamingFileLineKeyAndWhatIsAllowed) {
  const auto lines = problems(GetParam().text);
  ASSERT_EQ(lines.size(), 1U) << ::testing::PrintToString(lines);
  EXPECT_THAT(lines[0], StartsWith("/site/a.toml" + std::string(GetParam().place) + ": "));
  EXPECT_THAT(lines[0], HasSubstr(GetParam().says));
  EXPECT_EQ(lines[0].find('\n'), std::string::npos);
  EXPECT_FALSE(parse(GetParam().text).config);
}

std::string name_of(const ::testing::TestParamInfo<Wrong>& info) { return info.param.name; }

INSTANTIATE_TEST_SUITE_P(
    Types, WrongConfig,
    ::testing::Values(
        Wrong{"text_for_whole", other("[health]\nmin_matched = \"many\"\n"), ":2: health.min_matched",
              "is the text \"many\"; must be a whole number from 3 to 1000000"},
        Wrong{"fraction_for_whole", other("[health]\nrecover_frames = 2.5\n"), ":2: health.recover_frames",
              "is 2.5; must be a whole number"},
        Wrong{"number_for_text", other("[log]\nident = 5\n"), ":2: log.ident",
              "is 5; must be 1 to 32 letters"},
        Wrong{"number_for_flag", lidar("firing_correction = 1\n"), ":2: lidar.firing_correction",
              "is 1; must be true or false"},
        Wrong{"list_for_number", other("[health]\nq1_lost = [1, 2]\n"), ":2: health.q1_lost",
              "is [1.0, 2.0]; must be a number from"},
        Wrong{"date_for_number", other("[health]\nq1_lost = 2026-01-01\n"), ":2: health.q1_lost",
              "is a date or time"},
        Wrong{"number_for_list", hull("reference_point = 3\n"), ":2: hull.reference_point",
              "is 3; must be three numbers"},
        Wrong{"text_in_list", hull("reference_point = [1, \"2\", 3]\n"), ":2: hull.reference_point",
              "is a list; must be three numbers"},
        Wrong{"value_for_section", other("tracking = 5\n"), ":1: tracking",
              "is 5; must be a table, [tracking]"},
        Wrong{"value_for_inline_table", read("slew = 3\n"), ":2: plc.read.slew", "must be a table"},
        Wrong{"table_for_lidars", "[lidar]\nmodel = \"ouster_os\"\n" + kPlc + kHull, ":1: lidar",
              "written as [[lidar]] sections"}),
    name_of);

INSTANTIATE_TEST_SUITE_P(
    Ranges, WrongConfig,
    ::testing::Values(
        Wrong{"below", other("[tracking]\nframe_rate_hz = 0\n"), ":2: tracking.frame_rate_hz",
              "is 0.0; must be a number from 1.0 to 50.0 (Hz)"},
        Wrong{"above", plc("port = 65536\n"), ":2: plc.port",
              "is 65536; must be a whole number from 1 to 65535"},
        Wrong{"negative", plc("poll_period_ms = -20\n"), ":2: plc.poll_period_ms",
              "is -20; must be a whole number from 1 to 200 (ms)"},
        Wrong{"unit_id_reserved", plc("unit_id = 250\n"), ":2: plc.unit_id", "0 to 247, or 255"},
        Wrong{"nan", other("[tracking]\nvoxel_size = nan\n"), ":2: tracking.voxel_size",
              "is nan; must be a number"},
        Wrong{"infinity", hull("max_speed = +inf\n"), ":2: hull.max_speed", "is inf; must be a number"},
        Wrong{"nan_in_list", hull("reference_point = [0, nan, 0]\n"), ":2: hull.reference_point",
              "must be three numbers"},
        Wrong{"zero_scale", read("luff.scale = 0\n"), ":2: plc.read.luff.scale", "except 0"},
        Wrong{"sign", read("luff.sign = 0\n"), ":2: plc.read.luff.sign", "is 0; must be 1 or -1"},
        Wrong{"choice", read("word_order = \"ABDC\"\n"), ":2: plc.read.word_order",
              "must be \"ABCD\", \"CDAB\", \"BADC\" or \"DCBA\""},
        Wrong{"choice_near", other("[log]\nlevel = \"warnign\"\n"), ":2: log.level",
              "did you mean \"warning\"?"},
        Wrong{"facility", other("[log]\nfacility = \"local8\"\n"), ":2: log.facility",
              "must be one of \"daemon\", \"local0\""},
        Wrong{"ident", other("[log]\nident = \"a b\"\n"), ":2: log.ident",
              "is \"a b\"; must be 1 to 32 letters"},
        Wrong{"short_vector", hull("reference_point = [1, 2]\n"), ":2: hull.reference_point",
              "is [1.0, 2.0]; must be three numbers from -10000.0"},
        Wrong{"long_box", hull("region = [1, 2, 3, 4, 5, 6, 7]\n"), ":2: hull.region", "or [] for none"},
        Wrong{"envelope_upside_down", hull("envelope = [0, 0, 5, 1, 1, -5]\n"), ":2: hull.envelope",
              "the lower corner first"},
        Wrong{"empty_envelope", hull("envelope = []\n"), ":2: hull.envelope", "is []; must be six numbers"},
        Wrong{"exclude_not_nested", lidar("exclude = [0, 0, 0, 1, 1, 1]\n"), ":2: lidar.exclude",
              "must be a list of at most 64 boxes"},
        Wrong{"exclude_upside_down", lidar("exclude = [[0, 0, 0, 1, 1, -1]]\n"), ":2: lidar.exclude",
              "the lower corner first"},
        Wrong{"rotation", lidar("mount.rpy_deg = [0, 0, 400]\n"), ":2: lidar.mount.rpy_deg",
              "three numbers from -360.0 to 360.0 (deg)"}),
    name_of);

INSTANTIATE_TEST_SUITE_P(
    Addresses, WrongConfig,
    ::testing::Values(
        Wrong{"host_quad", "[plc]\nhost = \"192.168.1.300\"\n" + kLidar + kHull, ":2: plc.host",
              "must be an IP address or a host name"},
        Wrong{"host_short_quad", "[plc]\nhost = \"192.168.10\"\n" + kLidar + kHull, ":2: plc.host",
              "must be an IP address or a host name"},
        Wrong{"host_empty", "[plc]\nhost = \"\"\n" + kLidar + kHull, ":2: plc.host",
              "must be an IP address or a host name"},
        Wrong{"host_characters", "[plc]\nhost = \"plc one\"\n" + kLidar + kHull, ":2: plc.host",
              "must be an IP address or a host name"},
        Wrong{"bind", lidar("bind = \"localhost\"\n"), ":2: lidar.bind",
              "must be an IPv4 address of this computer"},
        Wrong{"source", lidar("source = \"192.168.1\"\n"), ":2: lidar.source", "or \"\" for any"},
        Wrong{"multicast", lidar("multicast = \"192.168.1.1\"\n"), ":2: lidar.multicast",
              "from 224.0.0.0 to 239.255.255.255"},
        Wrong{"model_near", "[[lidar]]\nmodel = \"velodyne_vpl16\"\n" + kPlc + kHull, ":2: lidar.model",
              "did you mean \"velodyne_vlp16\"?"},
        Wrong{"model_far", "[[lidar]]\nmodel = \"sonar\"\n" + kPlc + kHull, ":2: lidar.model",
              "is \"sonar\"; must be one of \"velodyne_vlp16\", \"velodyne_vlp32c\" or \"ouster_os\""}),
    name_of);

INSTANTIATE_TEST_SUITE_P(
    Names, WrongConfig,
    ::testing::Values(
        Wrong{"key_near", plc("prot = 502\n"), ":2: plc.prot", "unknown key; did you mean plc.port?"},
        Wrong{"key_swapped_letters", other("[health]\nmin_macthed = 5\n"), ":2: health.min_macthed",
              "did you mean health.min_matched?"},
        Wrong{"key_of_another_section", other("[health]\nvoxel_size = 1.0\n"), ":2: health.voxel_size",
              "unknown key; it belongs into [tracking]"},
        Wrong{"key_far", other("[log]\ncolour = \"red\"\n"), ":2: log.colour",
              "unknown key; known here: ident, facility, level"},
        Wrong{"key_in_inline_table", read("travel = { offset = 0, ofset = 1 }\n"),
              ":2: plc.read.travel.ofset", "did you mean plc.read.travel.offset?"},
        Wrong{"section_near", other("[trakcing]\nvoxel_size = 1\n"), ":1: trakcing",
              "unknown section; did you mean tracking?"},
        Wrong{"section_far", other("[weather]\nrain = true\n"), ":1: weather",
              "unknown section; known here: plc, machine, hull, quay, tracking, health, log, lidar"},
        Wrong{"lidars_near", other("[[lidars]]\nmodel = \"ouster_os\"\n"), ":1: lidars",
              "unknown section; did you mean lidar?"},
        Wrong{"host_missing", "[plc]\nport = 5\n" + kLidar + kHull, ":1: plc.host",
              "missing; must be an IP address"},
        Wrong{"plc_missing", kLidar + kHull, ":4: plc.host", "missing"},
        Wrong{"model_missing", "[[lidar]]\nname = \"b\"\n" + kPlc + kHull, ":1: lidar.model",
              "missing; must be one of"},
        Wrong{"lidar_missing", kPlc + kHull, ":4: lidar", "missing; give at least one [[lidar]] section"},
        Wrong{"no_lidar", "lidar = []\n" + kPlc + kHull, ":1: lidar", "give 1 to 16"},
        Wrong{"map_missing", kPlc + kLidar + "[hull]\n", ":5: hull.map",
              "missing; must be the name of a PCD or PLY file"},
        Wrong{"map_empty", kPlc + kLidar + "[hull]\nmap = \"\"\n", ":6: hull.map", "must be the name"}),
    name_of);

INSTANTIATE_TEST_SUITE_P(
    Syntax, WrongConfig,
    ::testing::Values(
        Wrong{"key_twice", plc("port = 1\nport = 2\n"), ":3: TOML syntax", "may be given once"},
        Wrong{"section_twice", other("[log]\n[log]\n"), ":2: TOML syntax", "may be given once"},
        Wrong{"no_value", plc("port =\n"), ":2: TOML syntax", "expected value"},
        Wrong{"open_text", plc("# fine\nhost2 = \"abc\n"), ":3: TOML syntax", "string"},
        Wrong{"open_table", read("slew = { offset = 1\n"), ":2: TOML syntax", "inline table"},
        Wrong{"header_without_a_name", "# one\n[= 1\n" + kPlc, ":2: TOML syntax", "key"},
        Wrong{"bad_utf8", "# \xC3\n" + kPlc, ":1: TOML syntax", "utf-8"},
        Wrong{"beyond_64_bits", other("[health]\nmin_matched = 99999999999999999999\n"), ":2: TOML syntax",
              "99999999999999999999"},
        Wrong{"umlaut_in_a_key", plc("schl\xC3\xBCssel = 1\n"), ":2: TOML syntax", "\xC3\xBC"},
        Wrong{"umlaut_after_a_string", plc("host2 = \"a\\\"b\" \xC3\xBC\n"), ":2: TOML syntax", "\xC3\xBC"},
        Wrong{"accent_alone", "\xCD\xA0", ":1: TOML syntax", "\xCD\xA0"},
        Wrong{"kana_in_a_wrong_number", plc("port = +%'\xE3\x81\x82'\n"), ":2: TOML syntax",
              "could not determine value type"},
        Wrong{"ligature_in_a_wrong_number", plc("port = +%'\xEF\xB3\xBF'\n"), ":2: TOML syntax",
              "could not determine value type"},
        Wrong{"long_line", "# one\n#" + std::string(5000, 'x') + "\n", ":2", "longer than 4096 characters"}),
    name_of);

INSTANTIATE_TEST_SUITE_P(
    BetweenKeys, WrongConfig,
    ::testing::Values(
        Wrong{"joints_overlap", read("travel.offset = 0\nslew.offset = 1\n"), ":3: plc.read.slew.offset",
              "takes registers 1 and 2, which plc.read.travel.offset takes too (registers 0 and 1)"},
        Wrong{"heartbeat_on_joint", read("heartbeat = 5\n"), ":2: plc.read.heartbeat",
              "takes register 5, which plc.read.luff.offset takes too"},
        Wrong{"tail_on_command", read("heartbeat_tail = 7\n"), ":2: plc.read.command",
              "takes register 7, which plc.read.heartbeat_tail takes too"},
        Wrong{"wide_joint_at_the_end",
              other("[plc.write]\nbase = 999\n[plc.read]\nluff = { offset = 124 }\n"),
              ":4: plc.read.luff.offset", "one read carries offsets 0 to 124"},
        Wrong{"read_block_too_high", read("base = 65530\n"), ":2: plc.read.base",
              "puts the read block at addresses 65530 to 65537; the last address is 65535"},
        Wrong{"write_block_too_high", other("[plc.write]\nbase = 65497\n"), ":2: plc.write.base",
              "a base of 65496 at most"},
        Wrong{"blocks_overlap", other("[plc.write]\nbase = 7\n"), ":2: plc.write.base",
              "addresses 7 to 46, over the read block at 0 to 7"},
        Wrong{"blocks_overlap_by_the_read_base", read("base = 139\n"), ":2: plc.write.base",
              "over the read block at 139 to 146"},
        Wrong{"limits_upside_down", read("slew = { min = 10, max = -10 }\n"), ":2: plc.read.slew.min",
              "is 10.0, not below max = -10.0"},
        Wrong{"heartbeat_faster_than_poll", plc("heartbeat_timeout_ms = 20\n"),
              ":2: plc.heartbeat_timeout_ms", "is not longer than poll_period_ms"},
        Wrong{"ranges_upside_down", lidar("max_range = 0.5\n"), ":2: lidar.min_range",
              "is 1.0, not below max_range = 0.5"},
        Wrong{"same_name", two_lidars("port = 1\n", "port = 2\n"), ":4: lidar.name",
              "is \"boom\", the name of another LiDAR too"},
        Wrong{"same_port", two_lidars("name = \"a\"\n", "name = \"b\"\nport = 7502\n"), ":7: lidar.port",
              "where LiDAR \"a\" listens too"},
        Wrong{"same_port_one_source", two_lidars("name = \"a\"\nsource = \"10.0.0.1\"\n", "name = \"b\"\n"),
              ":5: lidar.port", "a `source` to each"},
        Wrong{"same_port_two_sockets_one_for_every_address",
              two_lidars("name = \"a\"\nsource = \"10.0.0.1\"\n",
                         "name = \"b\"\nbind = \"10.0.0.9\"\nsource = \"10.0.0.2\"\n"),
              ":5: lidar.port", "the same `bind`"},
        Wrong{"same_port_two_sockets_for_multicast",
              two_lidars("name = \"a\"\nbind = \"10.0.0.1\"\nmulticast = \"239.0.0.1\"\n",
                         "name = \"b\"\nbind = \"10.0.1.1\"\nmulticast = \"239.0.0.2\"\n"),
              ":6: lidar.port", "a port of its own"},
        Wrong{"q1_limits", other("[health]\nq1_healthy = 0.3\nq1_lost = 0.25\n"), ":2: health.q1_healthy",
              "is 0.3, above q1_lost = 0.25"},
        Wrong{"q1_ratios", other("[health]\nq1_ratio_healthy = 3.5\n"), ":2: health.q1_ratio_healthy",
              "is 3.5, above q1_ratio_lost = 3.0"}),
    name_of);

TEST(ReadConfig, AcceptsWhatTheRulesBetweenKeysAllow) {
  for (const std::string& text : {
           two_lidars("name = \"a\"\nsource = \"10.0.0.1\"\n", "name = \"b\"\nsource = \"10.0.0.2\"\n"),
           two_lidars("name = \"a\"\nbind = \"10.0.0.1\"\n", "name = \"b\"\nbind = \"10.0.0.2\"\n"),
           plc("heartbeat_timeout_ms = 0\nread.heartbeat = 0\n"),  // a PLC without a heartbeat register
           read("travel.type = \"int16\"\nslew.offset = 1\n"),
           other("[plc.write]\nbase = 8\n"),
           other("[health]\nq1_healthy = 0.25\nq1_lost = 0.25\n"),
           other("[health]\nq1_healthy = 0.25\n"),
           other("[health]\nq1_healthy = 0.25\nq1_lost = 0\n"),  // 0 is none
           other("[health]\nq1_ratio_healthy = 3\n"),
       }) {
    EXPECT_THAT(problems(text), ::testing::IsEmpty()) << text;
  }
}

TEST(ReadConfig, ReportsEveryProblemInTheOrderOfTheLines) {
  const auto lines = problems(
      "[health]\nq1_ratio_healthy = 9\nmin_matched = 1\n[plc]\nprot = 1\n[plc.read]\nslew = { offset = 1, "
      "type = "
      "\"real\" }\n"
      "heartbeat = 4\n[[lidar]]\nname = \"\"\n[hull]\nmap = 5\n");
  EXPECT_THAT(lines, ElementsAre(StartsWith("/site/a.toml:2: health.q1_ratio_healthy: is 9.0, above"),
                                 StartsWith("/site/a.toml:3: health.min_matched: "),
                                 StartsWith("/site/a.toml:4: plc.host: missing"),
                                 StartsWith("/site/a.toml:5: plc.prot: unknown key"),
                                 StartsWith("/site/a.toml:7: plc.read.slew.type: is \"real\""),
                                 StartsWith("/site/a.toml:8: plc.read.heartbeat: takes register 4"),
                                 StartsWith("/site/a.toml:9: lidar.model: missing"),
                                 StartsWith("/site/a.toml:10: lidar.name: is \"\""),
                                 StartsWith("/site/a.toml:12: hull.map: is 5")));
}

TEST(ReadConfig, AbsolutePathsStayAndRelativeOnesStartAtTheFilesFolder) {
  const auto reading = parse(
      kPlc +
      "[[lidar]]\nmodel = \"ouster_os\"\ncalibration = \"/abs/c.json\"\n[hull]\nmap = \"a/../b.pcd\"\n");
  ASSERT_TRUE(reading.config);
  EXPECT_EQ(reading.config->lidars.at(0).calibration, "/abs/c.json");
  EXPECT_EQ(reading.config->map_file, "/site/b.pcd");
}

TEST(ReadConfig, LaterProblemsFindTheirLine) {
  const auto reading = parse(other("# a comment\n\n"));
  EXPECT_EQ(to_string(reading.problem_with("x.toml", "hull.map", "gone")), "x.toml:8: hull.map: gone");
  EXPECT_EQ(to_string(reading.problem_with("x.toml", "lidar.0.calibration", "gone")),
            "x.toml:5: lidar.calibration: gone")
      << "the line of the section, since the key is not there";
}

TEST(ReadConfig, ThePlcIsKnownWhileOnlyOthersHaveProblems) {
  EXPECT_TRUE(parse(kLeast).plc);
  for (const char* bad : {"[health]\nmin_matched = \"many\"\n", "[tracking]\nvoxel_sise = 1\n",
                          "[[lidar]]\nport = 1\n", "[machine]\nslewing = 1\n"}) {
    const auto reading = parse(kLeast + std::string(bad));
    EXPECT_FALSE(reading.problems.empty()) << bad;
    ASSERT_TRUE(reading.plc) << bad;
    EXPECT_EQ(reading.plc->host, "plc.example");
  }
}

TEST(ReadConfig, NoPlcIsKnownThatMayNotBeTheOneThatIsMeant) {
  for (const char* bad :
       {"[plc]\nhost = 5\n", "[plc]\nhost = \"a\"\nprot = 1502\n", "[plc]\n",
        "[plc]\nhost = \"a\"\n[plc.wrote]\nbase = 300\n", "[plc]\nhost = \"a\"\n[plcwrite]\nbase = 300\n",
        "[plc]\nhost = \"a\"\n[hull]\nbase = 300\n", "[plc]\nhost = \"a\"\n[[lidar]]\nunit_id = 2\n",
        "[plc]\nhost = \"a\"\n[plc.write]\nbase = 3\n", "[plc]\nhost = \"a\"\n[plc.write\n",
        "unit_id = 3\n[plc]\nhost = \"a\"\n", ""}) {
    const auto reading = parse(bad);
    EXPECT_FALSE(reading.problems.empty()) << bad;
    EXPECT_FALSE(reading.plc) << bad;
  }
}

TEST(ReadConfig, AFileThatCannotBeReadIsNamed) {
  const test::TempFolder folder;
  const auto missing = folder.path() / "none.toml";
  EXPECT_THAT(to_string(read_config(missing, kModels).problems.at(0)),
              StartsWith(missing.string() + ": cannot be read: No such file or directory"));
  EXPECT_THAT(to_string(read_config(folder.path(), kModels).problems.at(0)), HasSubstr("it is a folder"));
  const auto large = folder.file("large.toml", std::string((1 << 20) + 1, '\n'));
  EXPECT_THAT(to_string(read_config(large, kModels).problems.at(0)), HasSubstr("larger than 1 MiB"));
  const auto good = folder.file("good.toml", kLeast);
  EXPECT_TRUE(read_config(good, kModels).config);
}

TEST(ReadConfig, PortsAreTheModelsOwnUnlessTheyAreGiven) {
  const std::vector<LidarModel> models{{.name = "talkative", .port = 6699, .information_port = 7788}};
  const auto lidar = [&](const std::string& keys) {
    const std::string text = "[[lidar]]\n" + keys + "model = \"talkative\"\n" + kPlc + kHull;
    return parse_config(text, "/site/a.toml", models).config.value().lidars.at(0);
  };
  EXPECT_EQ(lidar("").port, 6699);
  EXPECT_EQ(lidar("").information_port, 7788);
  EXPECT_EQ(lidar("port = 2000\n").port, 2000);
  EXPECT_EQ(lidar("information_port = 0\n").information_port, 0);
}

TEST(ReadConfig, WhatAModelCannotDoIsAProblem) {
  const std::vector<LidarModel> models{{.name = "dull", .port = 1},
                                       {.name = "still", .port = 2, .rotates = false},
                                       {.name = "talkative", .port = 3, .information_port = 4}};
  const auto first_problem = [&](const std::string& lidars, const std::string& rest) {
    const auto reading = parse_config(lidars + kPlc + kHull + rest, "/site/a.toml", models);
    return reading.problems.empty() ? std::string() : to_string(reading.problems.front());
  };
  const auto lidar = [](const std::string& name, const std::string& model) {
    return "[[lidar]]\nname = \"" + name + "\"\nmodel = \"" + model + "\"\n";
  };
  const std::string turns = "[tracking]\nframing = \"revolution\"\n";
  EXPECT_THAT(first_problem(lidar("a", "still"), turns), HasSubstr("a still, does not rotate"));
  EXPECT_THAT(first_problem(lidar("a", "dull") + lidar("b", "still"), turns), IsEmpty());
  EXPECT_THAT(first_problem(lidar("a", "dull") + "information_port = 9\n", ""),
              HasSubstr("a dull tells nothing about itself"));
  EXPECT_THAT(first_problem(lidar("a", "talkative") + lidar("b", "talkative") + "port = 5\n", ""),
              HasSubstr("is 4, where LiDAR \"a\" listens too"));
}

}  // namespace
}  // namespace hulltrack
