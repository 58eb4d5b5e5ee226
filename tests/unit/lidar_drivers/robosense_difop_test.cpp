// What the decoder learns of the unit: angles, number of lasers, from the network or from a file.
#include <gtest/gtest.h>

#include <cmath>

#include "core/geometry/se3.hpp"
#include "lidar_drivers/model_registry.hpp"
#include "lidar_drivers/robosense/robosense_decoder.hpp"
#include "tests/support/robosense_bytes.hpp"
#include "tests/support/temp_folder.hpp"

namespace hulltrack {
namespace {

using robosense::RobosenseDecoder;
using test::block_azimuths;
using test::difop_bytes;
using test::put_angle;
using test::RobosenseBytes;

std::string_view text(const RobosenseBytes& bytes) {
  return {reinterpret_cast<const char*>(bytes.data()), bytes.size()};
}

double elevation_deg(const LidarPoint& point) {
  return degrees(std::atan2(point.z, std::hypot(point.x, point.y) - 0.03498));
}

/// Status of a data packet with one return, after `difop`; the elevation of the return if there is one.
std::pair<DecodeStatus, double> after(RobosenseDecoder& decoder, const RobosenseBytes& difop) {
  decoder.inform(difop);
  auto bytes = test::helios_bytes(block_azimuths(0, 40));
  test::put_echo(bytes, 0, 0, 4000);
  DecodedPacket packet;
  const auto outcome = decoder.decode(bytes, packet);
  return {outcome.status, packet.points.empty() ? 0.0 : elevation_deg(packet.points[0])};
}

TEST(RobosenseDifop, DataWaitForTheAnglesAndFollowThem) {
  RobosenseDecoder decoder(*robosense::find_model("robosense_helios32"), {});
  EXPECT_EQ(after(decoder, {}).first, DecodeStatus::awaiting_angles);
  EXPECT_NEAR(after(decoder, difop_bytes(32, 4)).second, 10.0, 1e-4);
  auto other = difop_bytes(32, 4);
  put_angle(other, test::kVertical, 0, 1234);
  decoder.inform(other);
  EXPECT_NEAR(after(decoder, other).second, 12.34, 1e-4) << "another unit, at its second packet";
}

TEST(RobosenseDifop, PacketsThatContradictEachOtherHoldTheDataBackUntilTwoInARowAgree) {
  const auto good = difop_bytes(32, 4);
  auto damaged = good;
  damaged[test::kVertical + 1] ^= 0x08;  // laser 0: by 20.48 deg
  RobosenseDecoder decoder(*robosense::find_model("robosense_helios32"), {});
  const auto held_back = [&](const RobosenseBytes& difop) {
    return after(decoder, difop).first == DecodeStatus::awaiting_angles;
  };
  // The very first one has nothing to be compared with.
  EXPECT_NEAR(after(decoder, damaged).second, 30.48, 1e-4);
  EXPECT_TRUE(held_back(good));
  EXPECT_NEAR(after(decoder, good).second, 10.0, 1e-4);
  EXPECT_NEAR(after(decoder, good).second, 10.0, 1e-4);
  EXPECT_TRUE(held_back(damaged));
  EXPECT_NE(decoder.explain({DecodeStatus::awaiting_angles, 0, kContradicted}).find("contradict"),
            std::string::npos);
  EXPECT_TRUE(held_back(good));
  EXPECT_NEAR(after(decoder, good).second, 10.0, 1e-4);
  // Two units on one port: neither's angles are used for the other's data.
  auto other_unit = good;
  put_angle(other_unit, test::kVertical, 0, 1050);
  for (int i = 0; i < 3; ++i) {
    EXPECT_TRUE(held_back(other_unit));
    EXPECT_TRUE(held_back(good));
  }
}

TEST(RobosenseDifop, AnglesThatNoUnitHasChangeNothing) {
  const auto good = difop_bytes(32, 4);
  auto not_calibrated = good;
  not_calibrated[test::kVertical] = 0xFF;
  auto too_steep = good;
  put_angle(too_steep, test::kVertical, 3, 9001);
  auto too_far_aside = good;
  put_angle(too_far_aside, test::kHorizontal, 3, -9001);
  auto twice = good;
  put_angle(twice, test::kVertical, 3, 1000);
  auto half_of_the_rest = good;
  for (std::size_t k = 24; k < 32; ++k) half_of_the_rest[test::kVertical + 3 * k] = 0xFF;
  auto other_id = good;
  other_id[2] ^= 1;
  auto shorter = good;
  shorter.pop_back();
  for (const auto& bad :
       {not_calibrated, too_steep, too_far_aside, twice, half_of_the_rest, other_id, shorter}) {
    RobosenseDecoder decoder(*robosense::find_model("robosense_helios32"), {});
    EXPECT_FALSE(decoder.inform(bad));
    EXPECT_EQ(after(decoder, bad).first, DecodeStatus::awaiting_angles);
    ASSERT_TRUE(decoder.inform(good));
    EXPECT_NEAR(after(decoder, bad).second, 10.0, 1e-4);
  }
}

TEST(RobosenseDifop, SixteenLasersAreCountedWhateverFillsTheRest) {
  const auto not_calibrated = difop_bytes(16, 4);
  auto zero = not_calibrated;
  auto repeated = not_calibrated;
  for (std::size_t k = 16; k < 32; ++k) {
    put_angle(zero, test::kVertical, k, 0);
    put_angle(zero, test::kHorizontal, k, 0);
    put_angle(repeated, test::kVertical, k, 1000 - 100 * static_cast<int>(k - 16));
    put_angle(repeated, test::kHorizontal, k, 0);
  }
  auto zero_not_used = zero;
  put_angle(zero_not_used, test::kVertical, 10, 55);  // then the filling itself looks like a laser
  for (const auto& difop : {not_calibrated, zero, repeated, zero_not_used}) {
    RobosenseDecoder right(*robosense::find_model("robosense_helios16p"), {});
    EXPECT_EQ(after(right, difop).first, DecodeStatus::ok);
    RobosenseDecoder wrong(*robosense::find_model("robosense_helios32"), {});
    EXPECT_EQ(after(wrong, difop).first, DecodeStatus::wrong_product);
  }
}

TEST(RobosenseDifop, AUnitOfAnotherModelIsNamed) {
  struct Case {
    const char* model;
    RobosenseBytes difop;
    const char* says;
  };
  const Case cases[] = {
      {"robosense_helios16p", difop_bytes(32, 4),
       "expected a unit of 16 lasers; this is a unit of 32 lasers: model = robosense_helios32?"},
      {"robosense_helios32", difop_bytes(16, 4),
       "expected a unit of 32 lasers; this is a unit of 16 lasers: model = robosense_helios16p?"},
      {"robosense_rs16", difop_bytes(32, 1),
       "expected a unit of 16 lasers; this is a unit of 32 lasers: model = robosense_rs32?"},
      {"robosense_rs32", test::rs16_difop_bytes(1),
       "expected a unit of 32 lasers; this is a unit of 16 lasers: model = robosense_rs16?"},
      {"robosense_rs32", test::bpearl_difop_bytes(1),
       "expected a unit of 32 lasers; this is a unit of 32 lasers up to the zenith: model = "
       "robosense_bpearl?"},
      {"robosense_bpearl", difop_bytes(32, 1),
       "expected a unit of 32 lasers up to the zenith; this is a unit of 32 lasers: model = robosense_rs32?"},
      {"robosense_helios32", test::bpearl_difop_bytes(0),
       "expected a unit of 32 lasers; this is a unit of 32 lasers up to the zenith"},
  };
  for (const Case& c : cases) {
    const bool helios = std::string_view(c.model).starts_with("robosense_helios");
    const auto azimuths = block_azimuths(0, 20);
    RobosenseDecoder decoder(*robosense::find_model(c.model), {});
    EXPECT_TRUE(decoder.inform(c.difop));
    DecodedPacket packet;
    const auto outcome =
        decoder.decode(helios ? test::helios_bytes(azimuths) : test::classic_bytes(azimuths), packet);
    EXPECT_EQ(outcome.status, DecodeStatus::wrong_product);
    EXPECT_EQ(decoder.explain(outcome), c.says);
  }
}

TEST(RobosenseDifop, TellsWhatTheClockFollows) {
  const auto reference = [](const char* model, RobosenseBytes difop, std::uint8_t state) {
    difop[302] = state;
    const bool helios = std::string_view(model).find("helios") != std::string_view::npos;
    RobosenseDecoder decoder(*robosense::find_model(model), {});
    EXPECT_TRUE(decoder.inform(difop));
    DecodedPacket packet;
    const auto azimuths = block_azimuths(0, 20);
    EXPECT_TRUE(
        decoder.decode(helios ? test::helios_bytes(azimuths) : test::classic_bytes(azimuths), packet).ok());
    return packet.clock_reference;
  };
  EXPECT_EQ(reference("robosense_helios32", difop_bytes(32, 4), 0), ClockReference::none);
  EXPECT_EQ(reference("robosense_helios32", difop_bytes(32, 4), 1), ClockReference::gps);
  EXPECT_EQ(reference("robosense_helios32", difop_bytes(32, 4), 2), ClockReference::ptp);
  EXPECT_EQ(reference("robosense_helios32", difop_bytes(32, 4), 3), ClockReference::unknown);
  EXPECT_EQ(reference("robosense_bpearl", test::bpearl_difop_bytes(1), 2), ClockReference::ptp);
  EXPECT_EQ(reference("robosense_rs32", difop_bytes(32, 1), 0), ClockReference::unknown) << "not its clock's";
}

TEST(RobosenseDifop, AFileStandsInForThePacket) {
  const test::TempFolder folder;
  const LidarModel& model = *find_lidar_model("robosense_helios32");
  auto old = difop_bytes(32, 4);
  old[302] = 2;
  auto decoder = make_lidar_decoder(model, {}, folder.file("difop.bin", text(old)));
  ASSERT_TRUE(decoder.ok());
  DecodedPacket packet;
  EXPECT_TRUE((*decoder)->decode(test::helios_bytes(block_azimuths(0, 20)), packet).ok());
  EXPECT_EQ(packet.clock_reference, ClockReference::unknown) << "that was then";

  const auto error = [&](const std::filesystem::path& file) {
    auto made = make_lidar_decoder(model, {}, file);
    return made.ok() ? std::string("ok") : made.error().message;
  };
  const std::string place = folder.path().string() + "/";
  EXPECT_EQ(error(place + "none"), place + "none cannot be read");
  EXPECT_EQ(error(folder.path()), folder.path().string() + " cannot be read");
  const auto good = difop_bytes(32, 4);
  EXPECT_EQ(error(folder.file("empty", "")), place + "empty has 0 bytes; a DIFOP packet has 1248");
  EXPECT_EQ(error(folder.file("cut", text(good).substr(1))),
            place + "cut has 1247 bytes; a DIFOP packet has 1248");
  EXPECT_EQ(error(folder.file("long", std::string(text(good)) + "x")),
            place + "long has more than the 1248 bytes of a DIFOP packet");
  EXPECT_EQ(error(folder.file("data", text(test::helios_bytes(block_azimuths(0, 20))))),
            place + "data is not a DIFOP packet: those begin with A5 FF 00 5A 11 11 55 55");
  EXPECT_EQ(error(folder.file("angles", text(test::empty_difop(4)))),
            place +
                "angles is a DIFOP packet without the angles of 16 or 32 lasers: allowed are elevations "
                "that all differ and angles within 90 deg");
  EXPECT_EQ(error(folder.file("sixteen", text(difop_bytes(16, 4)))),
            place +
                "sixteen: robosense_helios32: expected a unit of 32 lasers; this is a unit of 16 lasers: "
                "model = robosense_helios16p?");
}

}  // namespace
}  // namespace hulltrack
