// Metadata in both shapes, and what is said about a wrong one.
#include <gtest/gtest.h>

#include <fstream>
#include <random>

#include "lidar_drivers/model_registry.hpp"
#include "lidar_drivers/ouster/ouster_metadata.hpp"
#include "tests/support/ouster_bytes.hpp"
#include "tests/support/ouster_reference.hpp"
#include "tests/support/temp_folder.hpp"

namespace hulltrack {
namespace {

using ouster::Metadata;
using ouster::parse_metadata;
using ouster::Profile;
using test::OusterText;

std::string error_of(const std::string& text) {
  const Result<Metadata> metadata = parse_metadata(text, "os.json");
  return metadata ? "" : metadata.error().message;
}

/// `text` with `from` replaced by `to`.
std::string with(std::string text, const std::string& from, const std::string& to) {
  const std::size_t at = text.find(from);
  EXPECT_NE(at, std::string::npos) << from;
  return at == std::string::npos ? text : text.replace(at, from.size(), to);
}

TEST(OusterMetadata, BothShapesSayTheSame) {
  for (const std::string& text : {OusterText{}.flat(), OusterText{}.nested()}) {
    const Result<Metadata> m = parse_metadata(text, "os.json");
    ASSERT_TRUE(m.ok()) << m.error().message;
    EXPECT_EQ(m->profile, Profile::rng19);
    EXPECT_EQ(m->columns_per_packet, 16U);
    EXPECT_EQ(m->columns_per_frame, 1024);
    EXPECT_EQ(m->frames_per_second, 10);
    EXPECT_EQ(m->window_first, 0);
    EXPECT_EQ(m->window_last, 1023);
    EXPECT_EQ(m->serial, 122'000'000'007U);
    ASSERT_EQ(m->beams.size(), 16U);
    EXPECT_DOUBLE_EQ(m->beams[15].altitude, radians(-30.0));
    EXPECT_DOUBLE_EQ(m->beams[3].azimuth, radians(-10.0));
    EXPECT_EQ(m->beam_origin_x, 10.0);
    EXPECT_EQ(m->beam_origin_distance, 10.0);
    EXPECT_DOUBLE_EQ(m->lidar_to_sensor.translation().z(), 0.036);
    EXPECT_EQ(m->lidar_to_sensor.linear()(0, 0), -1.0);
    EXPECT_EQ(m->packet_bytes(), 32 + 16 * (12 + 16 * 12) + 32U);
  }
}

TEST(OusterMetadata, WithoutAProfileTheFirmwareIsAnOldOne) {
  OusterText text;
  text.profile = "";
  const auto m = parse_metadata(text.flat(), "os.json");
  ASSERT_TRUE(m.ok());
  EXPECT_EQ(m->profile, Profile::legacy);
  EXPECT_EQ(m->packet_bytes(), 16 * (16 + 12 * 16 + 4U));
}

TEST(OusterMetadata, TellsWhatTheClockFollows) {
  const auto reference = [](const std::string& keys) {
    const std::string mode = R"("lidar_mode": "1024x10")";
    const auto nested = parse_metadata(with(OusterText{}.nested(), mode, mode + keys), "os.json");
    const auto flat = parse_metadata(with(OusterText{}.flat(), mode, mode + keys), "os.json");
    EXPECT_EQ(nested->clock_reference, flat->clock_reference) << keys;
    return nested->clock_reference;
  };
  EXPECT_EQ(reference(""), ClockReference::unknown);
  EXPECT_EQ(reference(R"(, "timestamp_mode": "TIME_FROM_INTERNAL_OSC")"), ClockReference::none);
  EXPECT_EQ(reference(R"(, "timestamp_mode": "TIME_FROM_PTP_1588")"), ClockReference::ptp);
  const std::string pulse = R"(, "timestamp_mode": "TIME_FROM_SYNC_PULSE_IN")";
  EXPECT_EQ(reference(pulse), ClockReference::pulse);
  EXPECT_EQ(reference(pulse + R"(, "multipurpose_io_mode": "INPUT_NMEA_UART")"), ClockReference::gps);
  EXPECT_EQ(reference(pulse + R"(, "multipurpose_io_mode": "OFF")"), ClockReference::pulse);
  EXPECT_EQ(reference(R"(, "timestamp_mode": "TIME_FROM_THE_STARS")"), ClockReference::unknown);
}

TEST(OusterMetadata, ABeamTransformGoesBeforeTheSingleDistance) {
  OusterText text;
  text.origin += R"(, "beam_to_lidar_transform": [1, 0, 0, 12, 0, 1, 0, 0, 0, 0, 1, 5, 0, 0, 0, 1])";
  const auto m = parse_metadata(text.nested(), "os.json");
  ASSERT_TRUE(m.ok());
  EXPECT_EQ(m->beam_origin_x, 12.0);
  EXPECT_EQ(m->beam_origin_z, 5.0);
  EXPECT_EQ(m->beam_origin_distance, 13.0);
}

TEST(OusterMetadata, ErrorsNameFileKeyAndWhatIsAllowed) {
  const std::string flat = OusterText{}.flat();
  const std::string nested = OusterText{}.nested();
  struct Case {
    std::string text, message;
  };
  const Case cases[] = {
      {"", "os.json: is not JSON: wrong at byte 1"},
      {"[1, 2]", "os.json: is no JSON object, as an Ouster's metadata is"},
      {with(flat, "36", "1e999"), "os.json: is not JSON: a number is too large"},
      {with(flat, "lidar_mode", "mode"),
       "os.json: lidar_mode: is missing; allowed is one of 512x10, 512x20, 1024x10, 1024x20, 2048x10"},
      {with(nested, "1024x10", "1024x11"),
       "os.json: config_params.lidar_mode: is \"1024x11\"; allowed is one of 512x10, 512x20, 1024x10, "
       "1024x20, 2048x10"},
      {with(nested, "\"1024x10\"", "7"),
       "os.json: config_params.lidar_mode: is no text; allowed is one of 512x10, 512x20, 1024x10, 1024x20, "
       "2048x10"},
      {with(flat, "1024x10", "2048x10"),
       "os.json: data_format.columns_per_frame: is 1024, but lidar_mode says 2048"},
      {with(flat, "\"columns_per_packet\": 16", "\"columns_per_packet\": 15"),
       "os.json: data_format.columns_per_packet: is 15, which does not divide the frame's 1024 columns"},
      {with(flat, "\"columns_per_packet\": 16", "\"columns_per_packet\": 0.5"),
       "os.json: data_format.columns_per_packet: is 0.5; allowed is a whole number in [1, 128]"},
      {with(nested, "[0, 1023]", "[0, 1024]"),
       "os.json: lidar_data_format.column_window: value 1 is 1024; allowed is a list of 2 numbers in [0, "
       "1023]"},
      {with(nested, "[0, 1023]", "[0.5, 1023]"),
       "os.json: lidar_data_format.column_window: is not of whole numbers; allowed are two measurement ids"},
      {with(nested, "RNG19_RFL8_SIG16_NIR16", "FIVE_WORD_PIXEL"),
       "os.json: lidar_data_format.udp_profile_lidar: is \"FIVE_WORD_PIXEL\"; allowed is one of LEGACY, "
       "RNG19_RFL8_SIG16_NIR16, RNG19_RFL8_SIG16_NIR16_DUAL, RNG15_RFL8_NIR8"},
      {with(nested, "\"pixels_per_column\": 16", "\"pixels_per_column\": 32"),
       "os.json: lidar_data_format.pixels_per_column: differs from the 16 beam_altitude_angles"},
      {with(flat, "beam_altitude_angles", "angles"),
       "os.json: beam_altitude_angles: is missing; allowed is a list of 16 to 128 numbers in [-90, 90]"},
      {with(flat, "[30, 0,", "[30,"),
       "os.json: beam_altitude_angles: has 15 values; allowed is a list of 16 to 128 numbers in [-90, 90]"},
      {with(flat, "[30, 0,", "[30, 0, 0,"),
       "os.json: beam_azimuth_angles: has 16 values; allowed is a list of 17 numbers in [-90, 90]"},
      {with(with(flat, "[30, 0,", "[30, 0, 0,"), "[0, 0, 10", "[0, 0, 0, 10"),
       "os.json: beam_altitude_angles: has 17 values; allowed are 16, 32, 64 and 128"},
      {with(nested, "-30]", "-90.5]"),
       "os.json: beam_intrinsics.beam_altitude_angles: value 15 is -90.5; allowed is a list of 16 to 128 "
       "numbers "
       "in [-90, 90]"},
      {with(nested, "-30]", "null]"),
       "os.json: beam_intrinsics.beam_altitude_angles: value 15 is no number; allowed is a list of 16 to 128 "
       "numbers in [-90, 90]"},
      {with(nested, "lidar_origin_to_beam_origin_mm", "n"),
       "os.json: lidar_origin_to_beam_origin_mm: is missing; allowed is a number in [0, 1000]"},
      {with(nested, "_mm\": 10", "_mm\": -1"),
       "os.json: beam_intrinsics.lidar_origin_to_beam_origin_mm: is -1; allowed is a number in [0, 1000]"},
      {with(nested, "lidar_to_sensor_transform\": [", "lidar_to_sensor_transform\": [0, "),
       "os.json: lidar_intrinsics.lidar_to_sensor_transform: has 17 values; allowed is a list of 16 numbers "
       "in "
       "[-1000, 1000]"},
      {with(nested, "[-1, 0", "[1, 0"),
       "os.json: lidar_intrinsics.lidar_to_sensor_transform: is no rigid transform; allowed is a rotation, a "
       "translation in mm and the row 0, 0, 0, 1"},
      {with(flat, "\"122000000007\"", "122"),
       "os.json: prod_sn: is no text; allowed is the serial number's digits"},
  };
  for (const Case& c : cases) EXPECT_EQ(error_of(c.text), c.message);
}

TEST(OusterMetadata, TheFrameMayBeNoLargerThanUdpCarries) {
  OusterText text;
  std::string list = "[0";
  for (int i = 1; i < 128; ++i) list += ",0";
  text.altitudes = text.azimuths = list + "]";
  const std::string json = with(with(text.flat(), "\"pixels_per_column\": 16", "\"pixels_per_column\": 128"),
                                "\"columns_per_packet\": 16", "\"columns_per_packet\": 64");
  EXPECT_EQ(error_of(json),
            "os.json: columns_per_packet: 64 columns make a datagram of 99136 bytes; UDP carries 65507");
}

TEST(OusterMetadata, DamagedFilesAreRefusedNeverFollowed) {
  const std::string good = OusterText{}.nested();
  for (std::size_t size = 0; size < good.size(); ++size) EXPECT_NE(error_of(good.substr(0, size)), "");
  EXPECT_NE(error_of(std::string(100'000, '[')), "");
  std::mt19937 random(3);
  for (int run = 0; run < 5'000; ++run) {
    std::string text = good;
    for (int i = 0; i < 3; ++i) text[random() % text.size()] = static_cast<char>(random());
    const auto m = parse_metadata(text, "os.json");
    if (!m) continue;
    EXPECT_LE(m->packet_bytes(), 65'507U);
    EXPECT_EQ(m->beams.size(), 16U);
  }
}

TEST(OusterMetadata, FilesThatCannotBeReadAreNamed) {
  const test::TempFolder folder;
  const auto model = find_lidar_model("ouster_os");
  ASSERT_NE(model, nullptr);
  EXPECT_EQ(make_lidar_decoder(*model, {}, {}).error().message,
            "ouster_os needs a calibration file: metadata JSON");
  const auto missing = folder.path() / "none.json";
  EXPECT_EQ(make_lidar_decoder(*model, {}, missing).error().message, missing.string() + ": cannot be opened");
  EXPECT_FALSE(make_lidar_decoder(*model, {}, folder.path()).ok());
  const auto large = folder.path() / "large.json";
  std::ofstream(large) << std::string(1'000'001, ' ');
  EXPECT_EQ(make_lidar_decoder(*model, {}, large).error().message,
            large.string() + ": is larger than 1000000 bytes, so no sensor's metadata");
  const auto good = folder.path() / "good.json";
  std::ofstream(good) << OusterText{}.flat();
  EXPECT_TRUE(make_lidar_decoder(*model, {}, good).ok());
}

TEST(OusterMetadata, ARealSensorsFileIsRead) {
  const auto file = test::ouster_reference_folder() / "metadata.json";
  if (!std::filesystem::exists(file)) GTEST_SKIP() << "no reference capture in " << file.parent_path();
  const auto m = ouster::read_metadata(file);
  ASSERT_TRUE(m.ok()) << m.error().message;
  EXPECT_EQ(m->profile, Profile::rng15);
  EXPECT_EQ(m->beams.size(), 128U);
  EXPECT_EQ(m->packet_bytes(), 8448U);
  EXPECT_EQ(m->serial, 122'201'000'998U);
  EXPECT_EQ(m->beam_origin_x, 15.806);
}

}  // namespace
}  // namespace hulltrack
