#include "core/io/map_file.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <limits>
#include <string>
#include <vector>

#include "core/io/pcd_writer.hpp"
#include "tests/support/temp_folder.hpp"

namespace hulltrack {
namespace {

using test::TempFolder;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::StartsWith;

const Cloud kCloud = {{1.5F, -2.25F, 3.0F}, {0.1F, 100.0F, -7.5F}, {-9999.0F, 0.0F, 1e-6F}};

template <typename T>
std::string bytes_of(T value, bool swap = false) {
  std::string raw(sizeof value, '\0');
  std::memcpy(raw.data(), &value, sizeof value);
  return swap ? std::string(raw.rbegin(), raw.rend()) : raw;
}

std::string floats(const std::vector<float>& values, bool swap = false) {
  std::string raw;
  for (const float value : values) {
    raw += bytes_of(value, swap);
  }
  return raw;
}

std::string pcd_header(const std::string& points, const std::string& data) {
  return "# .PCD v0.7 - Point Cloud Data file format\nVERSION 0.7\nFIELDS x y z\nSIZE 4 4 4\nTYPE F F F\n"
         "COUNT 1 1 1\nWIDTH " +
         points + "\nHEIGHT 1\nVIEWPOINT 0 0 0 1 0 0 0\nPOINTS " + points + "\nDATA " + data + "\n";
}

std::string ply_header(const std::string& format, const std::string& points) {
  return "ply\nformat " + format + " 1.0\ncomment a ship\nelement vertex " + points +
         "\nproperty uchar label\nproperty float x\nproperty float y\nproperty float z\n"
         "element face 1\nproperty list uchar int vertex_indices\nend_header\n";
}

TEST(MapFile, WhatWritePcdWroteReadsBackBitForBit) {
  const TempFolder folder;
  ASSERT_TRUE(write_pcd(folder.path() / "a.pcd", kCloud));
  const auto map = read_map_file(folder.path() / "a.pcd");
  ASSERT_TRUE(map) << map.error().message;
  EXPECT_EQ(map->cloud, kCloud);
  EXPECT_EQ(map->dropped, 0U);
  const std::vector<float> intensity = {1.0F, 2.0F, 3.0F};
  ASSERT_TRUE(write_pcd(folder.path() / "b.pcd", kCloud, intensity));
  EXPECT_EQ(read_map_file(folder.path() / "b.pcd")->cloud, kCloud);
}

TEST(MapFile, ReadsAsciiPcdWithOtherFieldsAroundTheCoordinates) {
  const TempFolder folder;
  const auto file =
      folder.file("a.pcd",
                  "VERSION .7\r\nFIELDS rgb x y normal z\r\nSIZE 4 4 8 4 4\r\nTYPE U F F F F\r\n"
                  "COUNT 1 1 1 3 1\r\nWIDTH 2\r\nHEIGHT 1\r\nPOINTS 2\r\nDATA ascii\r\n"
                  "255 1.5 -2.25 0 0 1 3\r\n7\t0.1 1e2 nan nan nan -7.5");
  const auto map = read_map_file(file);
  ASSERT_TRUE(map) << map.error().message;
  EXPECT_EQ(map->cloud, Cloud(kCloud.begin(), kCloud.begin() + 2));
}

TEST(MapFile, ReadsBinaryPcdWithDoublesAndPadding) {
  const TempFolder folder;
  const std::string point = "pad!" + bytes_of(1.5) + bytes_of(-2.25) + bytes_of(3.0);
  const auto file =
      folder.file("a.pcd",
                  "VERSION 0.7\nFIELDS _ x y z\nSIZE 1 8 8 8\nTYPE U F F F\nCOUNT 4 1 1 1\nWIDTH 1\n"
                  "HEIGHT 1\nPOINTS 1\nDATA binary\n" +
                      point + "trailing bytes are nobody's");
  const auto map = read_map_file(file);
  ASSERT_TRUE(map) << map.error().message;
  EXPECT_EQ(map->cloud, Cloud(kCloud.begin(), kCloud.begin() + 1));
}

TEST(MapFile, ReadsPlyInAllThreeFormats) {
  const TempFolder folder;
  const auto ascii =
      folder.file("a.ply", ply_header("ascii", "2") + "1 1.5 -2.25 3\n0 0.1 100 -7.5\n3 0 1 2\n");
  EXPECT_EQ(read_map_file(ascii)->cloud, Cloud(kCloud.begin(), kCloud.begin() + 2));
  for (const bool big : {false, true}) {
    const auto file =
        folder.file("b.ply", ply_header(big ? "binary_big_endian" : "binary_little_endian", "2") + "\1" +
                                 floats({1.5F, -2.25F, 3.0F}, big) + "\2" +
                                 floats({0.1F, 100.0F, -7.5F}, big) + "a face");
    const auto map = read_map_file(file);
    ASSERT_TRUE(map) << map.error().message;
    EXPECT_EQ(map->cloud, Cloud(kCloud.begin(), kCloud.begin() + 2)) << "big-endian: " << big;
  }
}

TEST(MapFile, FewUnusablePointsAreDroppedAndCounted) {
  const TempFolder folder;
  Cloud cloud = kCloud;
  cloud.push_back({std::nanf(""), 0.0F, 0.0F});
  cloud.push_back({0.0F, std::numeric_limits<float>::infinity(), 0.0F});
  ASSERT_TRUE(write_pcd(folder.path() / "a.pcd", cloud));
  const auto map = read_map_file(folder.path() / "a.pcd");
  ASSERT_TRUE(map) << map.error().message;
  EXPECT_EQ(map->cloud, kCloud);
  EXPECT_EQ(map->dropped, 2U);
  const std::string words = "a.pcd: 2 of its " + std::to_string(kCloud.size() + 2) + " points are no numbers";
  EXPECT_THAT(remarks_on("a.pcd", *map), ElementsAre(StartsWith(words)));
  EXPECT_THAT(remarks_on("a.pcd", MapFile{kCloud}), IsEmpty());
}

/// A header with this VIEWPOINT, for doubles.
std::string moved_header(const std::string& viewpoint, const std::string& data) {
  return "VERSION 0.7\nFIELDS x y z\nSIZE 8 8 8\nTYPE F F F\nCOUNT 1 1 1\nWIDTH 2\nHEIGHT 1\nVIEWPOINT " +
         viewpoint + "\nPOINTS 2\nDATA " + data + "\n";
}

// A third of a turn about (1, 1, 1), which makes x y z of y z x: (a, b, c) becomes (c, a, b). Then the shift.
constexpr const char* kTurned = "100 20 3 0.5 0.5 0.5 0.5";

TEST(MapFile, PointsLieWhereTheFilesOwnViewpointPutsThem) {
  const TempFolder folder;
  std::string columns;  // as DATA binary_compressed has them: all x, all y, all z, here as literals alone
  for (const double value : {1.0, 4.0, 2.0, 5.0, 3.0, 6.0}) {
    columns += bytes_of(value);
  }
  const std::string packed = std::string(1, '\x1F') + columns.substr(0, 32) + "\x0F" + columns.substr(32);
  const std::vector<std::string> files{moved_header(kTurned, "ascii") + "1 2 3\n4 5 6\n",
                                       moved_header(kTurned, "binary") + bytes_of(1.0) + bytes_of(2.0) +
                                           bytes_of(3.0) + bytes_of(4.0) + bytes_of(5.0) + bytes_of(6.0),
                                       moved_header(kTurned, "binary_compressed") +
                                           bytes_of(static_cast<std::uint32_t>(packed.size())) +
                                           bytes_of(48U) + packed};
  for (const std::string& content : files) {
    const auto map = read_map_file(folder.file("a.pcd", content));
    ASSERT_TRUE(map) << map.error().message;
    ASSERT_EQ(map->cloud.size(), 2U);
    EXPECT_LT((map->cloud[0] - Point(103.0F, 21.0F, 5.0F)).norm(), 1e-5F) << map->cloud[0].transpose();
    EXPECT_LT((map->cloud[1] - Point(106.0F, 24.0F, 8.0F)).norm(), 1e-5F) << map->cloud[1].transpose();
    EXPECT_THAT(
        remarks_on("a.pcd", *map),
        ElementsAre(StartsWith("a.pcd: its VIEWPOINT shifts the points by 100.000, 20.000, 3.000 m and turns "
                               "them by 120.000 deg, and so they are used")));
  }
}

TEST(MapFile, AViewpointFarAwayCostsNoMillimetre) {
  // Site coordinates in the shift, which the points take back: what is left fits in a float, the parts do
  // not.
  const TempFolder folder;
  const auto map =
      read_map_file(folder.file("a.pcd", moved_header("-500000.125 -5700000.25 0 1 0 0 0", "ascii") +
                                             "500001.126 5700002.253 3\n500000.125 5700000.25 0\n"));
  ASSERT_TRUE(map) << map.error().message;
  EXPECT_LT((map->cloud[0] - Point(1.001F, 2.003F, 3.0F)).norm(), 1e-5F) << map->cloud[0].transpose();
}

TEST(MapFile, AViewpointPrintedToThreeDigitsIsTheTurnItStandsFor) {
  const TempFolder folder;
  const auto map = read_map_file(
      folder.file("a.pcd", moved_header("0 0 0 0.707 0 0 0.707", "ascii") + "10 0 0\n0 10 0\n"));
  ASSERT_TRUE(map) << map.error().message;
  EXPECT_LT((map->cloud[0] - Point(0.0F, 10.0F, 0.0F)).norm(), 1e-5F) << "neither longer nor shorter";
}

TEST(MapFile, OfTheIdentityAsViewpointNothingIsSaid) {
  const TempFolder folder;
  const auto map =
      read_map_file(folder.file("a.pcd", moved_header("0 0 0 1 0 0 0", "ascii") + "1 2 3\n4 5 6\n"));
  ASSERT_TRUE(map);
  EXPECT_THAT(remarks_on("a.pcd", *map), IsEmpty());
}

struct Broken {
  const char* name;
  std::string content;
  const char* says;
};

class BrokenMap : public ::testing::TestWithParam<Broken> {};

TEST_P(BrokenMap, IsRefusedWithOneLineNamingTheFile) {
  const TempFolder folder;
  const auto file = folder.file("hull.pcd", GetParam().content);
  const auto map = read_map_file(file);
  ASSERT_FALSE(map);
  EXPECT_THAT(map.error().message, StartsWith(file.string() + ": "));
  EXPECT_THAT(map.error().message, HasSubstr(GetParam().says));
  EXPECT_EQ(map.error().message.find('\n'), std::string::npos);
}

const float kNan = std::numeric_limits<float>::quiet_NaN();

INSTANTIATE_TEST_SUITE_P(
    Kinds, BrokenMap,
    ::testing::Values(
        Broken{"empty", "", "is empty"},
        Broken{"wrong_format", "solid hull\nfacet normal 0 0 1\n", "neither a PCD nor a PLY"},
        Broken{"picture", std::string("\x89PNG\r\n\x1a\n\0\0", 10), "neither a PCD nor a PLY"},
        Broken{"pcd_header_cut", pcd_header("3", "binary").substr(0, pcd_header("3", "binary").find("WIDTH")),
               "cut short"},
        Broken{"pcd_no_points", pcd_header("0", "binary"), "has no points"},
        Broken{"pcd_truncated_binary", pcd_header("3", "binary") + std::string(35, '\0'),
               "cut short: its header promises 36 bytes of points, 35 are there"},
        Broken{"pcd_truncated_ascii", pcd_header("3", "ascii") + "1 2 3\n4 5 6\n",
               "promises 3 points, 2 are there"},
        Broken{"pcd_absurd_size", pcd_header("4000000000", "binary") + std::string(36, '\0'),
               "says 4000000000 points, at most 20000000"},
        Broken{"pcd_overflowing_size", pcd_header("99999999999999999999", "binary"), "line 7: `WIDTH"},
        Broken{"pcd_negative_size", pcd_header("-3", "binary"), "line 7: `WIDTH -3`"},
        Broken{"pcd_width_against_points",
               "VERSION 0.7\nFIELDS x y z\nSIZE 4 4 4\nTYPE F F F\nWIDTH 2\nHEIGHT 2\nPOINTS 3\nDATA ascii\n",
               "POINTS 3, but WIDTH * HEIGHT is 4"},
        Broken{"pcd_bad_number", pcd_header("2", "ascii") + "1 2 3\n4 five 6\n",
               "line 13: value 2 is `five`, must be a number"},
        Broken{"pcd_missing_value", pcd_header("1", "ascii") + "1 2\n",
               "line 12: has 2 values, the header promises 3"},
        Broken{"pcd_without_z", "VERSION 0.7\nFIELDS x y\nSIZE 4 4\nTYPE F F\nWIDTH 1\nDATA ascii\n1 2\n",
               "no field z"},
        Broken{"pcd_integer_coordinates",
               "VERSION 0.7\nFIELDS x y z\nSIZE 4 4 4\nTYPE I I I\nWIDTH 1\nDATA ascii\n1 2 3\n",
               "no field x of type F"},
        Broken{"pcd_unknown_data", pcd_header("1", "zipped"), "line 11: `DATA zipped`"},
        Broken{"pcd_field_count_mismatch", "VERSION 0.7\nFIELDS x y z\nSIZE 4 4\nTYPE F F F\n",
               "line 3: `SIZE 4 4`"},
        Broken{"pcd_huge_count", "VERSION 0.7\nFIELDS x y z\nSIZE 4 4 4\nTYPE F F F\nCOUNT 1 1 4000000000\n",
               "line 5"},
        Broken{"pcd_without_width", "VERSION 0.7\nFIELDS x y z\nDATA ascii\n", "no WIDTH"},
        Broken{"pcd_compressed_truncated", pcd_header("3", "binary_compressed") + floats({1.0F}),
               "cut short"},
        Broken{"pcd_compressed_lies",
               pcd_header("1000000", "binary_compressed") + bytes_of(4U) + bytes_of(12'000'000U) + "abcd",
               "compressed points are damaged"},
        Broken{"pcd_compressed_damaged",
               pcd_header("1", "binary_compressed") + bytes_of(4U) + bytes_of(12U) + "\xFF\xFF\xFF\xFF",
               "compressed points are damaged"},
        Broken{"pcd_viewpoint_short", moved_header("0 0 0 1 0 0", "ascii") + "1 2 3\n4 5 6\n",
               "line 8: VIEWPOINT must be seven finite numbers"},
        Broken{"pcd_viewpoint_empty", moved_header("", "ascii") + "1 2 3\n4 5 6\n",
               "line 8: VIEWPOINT must be seven finite numbers"},
        Broken{"pcd_viewpoint_nan", moved_header("0 nan 0 1 0 0 0", "ascii") + "1 2 3\n4 5 6\n",
               "line 8: VIEWPOINT must be seven finite numbers"},
        Broken{"pcd_viewpoint_long", moved_header("0 0 0 1 0 0 0 0", "ascii") + "1 2 3\n4 5 6\n",
               "line 8: VIEWPOINT has more than seven numbers"},
        Broken{"pcd_viewpoint_of_no_turn", moved_header("0 0 0 0 0 0 0", "ascii") + "1 2 3\n4 5 6\n",
               "line 8: the quaternion of VIEWPOINT has the length 0.000000, must be 1 to 0.001"},
        Broken{"pcd_viewpoint_not_unit", moved_header("0 0 0 0.71 0 0 0.71", "ascii") + "1 2 3\n4 5 6\n",
               "line 8: the quaternion of VIEWPOINT has the length 1.004"},
        Broken{"pcd_all_nan", pcd_header("2", "binary") + floats(std::vector<float>(6, kNan)),
               "2 of its 2 points are not finite"},
        Broken{"pcd_half_nan", pcd_header("2", "ascii") + "1 2 3\nnan nan nan\n",
               "1 of its 2 points are not finite"},
        Broken{"pcd_far_away", pcd_header("1", "ascii") + "500000 5700000 3\n",
               "farther than 10 km from the origin"},
        Broken{"ply_header_cut", "ply\nformat ascii 1.0\nelement vertex 3\n", "no end_header"},
        Broken{"ply_truncated", ply_header("binary_little_endian", "3") + std::string(38, '\0'),
               "promises 39 bytes of points, 38"},
        Broken{"ply_truncated_ascii", ply_header("ascii", "3") + "0 1 2 3\n", "promises 3 points, 1"},
        Broken{"ply_absurd_size", ply_header("binary_little_endian", "4000000000"), "says 4000000000 points"},
        Broken{"ply_no_points", ply_header("ascii", "0"), "has no points"},
        Broken{"ply_bad_number", ply_header("ascii", "1") + "0 1 two 3\n", "line 12: value 3 is `two`"},
        Broken{"ply_missing_value", ply_header("ascii", "1") + "0 1 2\n",
               "line 12: has 3 values, the header promises 4"},
        Broken{"ply_unknown_format", ply_header("utf8", "1"), "line 2: the format must be"},
        Broken{"ply_faces_first", "ply\nformat ascii 1.0\nelement face 1\nend_header\n",
               "line 3: the first element must be vertex"},
        Broken{"ply_list_in_vertex", "ply\nformat ascii 1.0\nelement vertex 1\nproperty list uchar int a\n",
               "line 4: a vertex may"},
        Broken{"ply_without_coordinates",
               "ply\nformat ascii 1.0\nelement vertex 1\nproperty float a\nend_header\n",
               "no property float x"},
        Broken{"ply_strange_line", "ply\nformat ascii 1.0\nvertices 3\n", "line 3: `vertices`"}),
    [](const auto& kind) { return std::string(kind.param.name); });

TEST(MapFile, MissingFileAndFolderAreNamed) {
  const TempFolder folder;
  const auto missing = folder.path() / "none.pcd";
  EXPECT_THAT(read_map_file(missing).error().message,
              StartsWith(missing.string() + ": cannot be opened: No such file"));
  EXPECT_THAT(read_map_file(folder.path()).error().message, HasSubstr("is not a file"));
}

TEST(WritePcd, AFullDiskIsReported) {
  if (!std::filesystem::exists("/dev/full")) {
    GTEST_SKIP() << "needs /dev/full";
  }
  EXPECT_THAT(write_pcd("/dev/full", kCloud).error().message, HasSubstr("No space left"));
}

}  // namespace
}  // namespace hulltrack
