// Angle correction files of a Hesai: what is read, what is refused and how it is said.
#include <gtest/gtest.h>

#include "lidar_drivers/hesai/hesai_angles.hpp"
#include "lidar_drivers/model_registry.hpp"
#include "tests/support/temp_folder.hpp"

namespace hulltrack {
namespace {

const hesai::ModelTable& xt16() { return *hesai::find_model("hesai_xt16"); }

/// Lines of the 16 lasers of an XT-16, all a tenth of a degree off the design.
std::string lines(int from = 1, int to = 16, const char* end = "\n") {
  std::string text;
  for (int k = from; k <= to; ++k)
    text += std::to_string(k) + "," + std::to_string(17 - 2 * k) + ".1,-0.1" + end;
  return text;
}

std::string refusal(const std::string& content, const hesai::ModelTable& model = xt16()) {
  const auto angles = hesai::parse_angles(content, "a.csv", model);
  return angles.ok() ? "ok" : angles.error().message;
}

constexpr const char* kHeader = "Channel,Elevation,Azimuth\n";

TEST(HesaiAngles, AreReadByChannelInAnyOrder) {
  const auto angles =
      hesai::parse_angles(kHeader + lines(9, 16) + "1,15.5,-1e-1\n" + lines(2, 8), "a.csv", xt16());
  ASSERT_TRUE(angles.ok());
  ASSERT_EQ(angles->size(), 16U);
  EXPECT_EQ((*angles)[0].elevation_deg, 15.5);
  EXPECT_EQ((*angles)[0].azimuth_deg, -0.1);
  EXPECT_EQ((*angles)[7].elevation_deg, 1.1);
}

TEST(HesaiAngles, DressOfTheFileDoesNotMatter) {
  EXPECT_EQ(refusal("\xEF\xBB\xBF"
                    "Channel,Elevation,Azimuth\r\n" +
                    lines(1, 16, "\r\n")),
            "ok");
  EXPECT_EQ(refusal("EEFF,1,1\nLaser id, Elevation, Azimuth\n" + lines() + std::string(64, 'a') + "\n"),
            "ok");
  EXPECT_EQ(refusal("# from the web page\n\n" + (kHeader + lines())), "ok");
  std::string unended = kHeader + lines();
  unended.pop_back();
  EXPECT_EQ(refusal(unended), "ok");
}

TEST(HesaiAngles, RefusalsNameTheLineAndWhatIsAllowed) {
  EXPECT_EQ(refusal(""), "a.csv: holds no line `Channel,Elevation,Azimuth`");
  EXPECT_EQ(refusal(lines()),
            "a.csv:1: the first line must be `Channel,Elevation,Azimuth`, it is `1,15.1,-0.1`");
  EXPECT_EQ(refusal(kHeader + lines(1, 15)),
            "a.csv: channel 16 is missing; a hesai_xt16 has the channels 1 to 16");
  EXPECT_EQ(refusal(kHeader + lines() + "17,-17,0\n"),
            "a.csv:18: channel is \"17\"; a hesai_xt16 has the channels 1 to 16");
  EXPECT_EQ(refusal(kHeader + lines() + "-1,-17,0\n"),
            "a.csv:18: channel is \"-1\"; a hesai_xt16 has the channels 1 to 16");
  EXPECT_EQ(refusal(kHeader + lines() + "3,11,0\n"), "a.csv:18: channel 3 stands in line 4 already");
  EXPECT_EQ(refusal(kHeader + std::string("1,15\n")), "a.csv:2: must have 3 fields, has 2");
  for (const char* bad : {"", "abc", "nan", "inf", "1e999", "15.0x", "12.9", "-15"}) {
    EXPECT_EQ(refusal(kHeader + ("1," + std::string(bad) + ",0\n")),
              "a.csv:2: elevation is \"" + std::string(bad) +
                  "\"; must be a number of degrees from 13.00 to 17.00 for this channel of a hesai_xt16");
  }
  EXPECT_EQ(
      refusal(kHeader + std::string("1,15,2.5\n")),
      "a.csv:2: azimuth is \"2.5\"; must be a number of degrees from -2.00 to 2.00 for this channel of a "
      "hesai_xt16");
}

TEST(HesaiAngles, AFileOfAnotherModelIsRefused) {
  std::string xt32m = kHeader;
  const auto& other = *hesai::find_model("hesai_xt32m");
  for (std::size_t k = 0; k < other.lasers; ++k)
    xt32m += std::to_string(k + 1) + "," + std::to_string(other.nominal[k].elevation_deg) + ",0\n";
  EXPECT_EQ(refusal(xt32m, other), "ok");
  EXPECT_EQ(
      refusal(xt32m, *hesai::find_model("hesai_xt32")),
      "a.csv:2: elevation is \"19.500000\"; must be a number of degrees from 13.00 to 17.00 for this channel "
      "of a hesai_xt32");
}

TEST(HesaiAngles, FilesAreReadBoundedAndWithoutOneTheDesignCounts) {
  const test::TempFolder folder;
  const auto file = folder.path() / "angles.csv";
  const LidarModel& model = *find_lidar_model("hesai_xt16");
  const auto error = [&] { return make_lidar_decoder(model, {}, file).error().message; };
  EXPECT_EQ(error(), file.string() + ": cannot be opened as an angle correction file");
  folder.file("angles.csv", std::string(70'000, '\n'));
  EXPECT_EQ(error(), file.string() + ": is longer than 65536 bytes; is this an angle correction file?");
  folder.file("angles.csv", kHeader + lines());
  EXPECT_TRUE(make_lidar_decoder(model, {}, file).ok());
  EXPECT_FALSE(make_lidar_decoder(model, {}, folder.path()).ok());

  EXPECT_EQ(hesai::load_angles({}, xt16())->size(), 16U);
  EXPECT_EQ(hesai::load_angles({}, xt16())->at(15).elevation_deg, -15.0);
}

}  // namespace
}  // namespace hulltrack
