// What one process hands to another: arrives as it was, or not at all.
#include "daemon/service/prepared_files.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <limits>

#include "core/io/map_file.hpp"
#include "daemon/service/memory_file.hpp"

namespace hulltrack {
namespace {

std::string bytes_of(const PreparedFiles& files) {
  MemoryFile file("test");
  write_prepared_files(file.fd(), files);
  file.seal();
  return std::string(MappedBytes(file).bytes());
}

PreparedFiles good_files() {
  return {.calibrations = {"", std::string("a\0b", 3)},
          .map_remark = "one point left out",
          .map_H = {{1, 2, 3}, {4, 5, 6}},
          .quay_W = {{7, 8, 9}}};
}

PreparedFiles bad_files() {
  return {.problems = {{"/a.toml", 7, "hull.map: gone"}, {"/b.toml", 0, "is empty"}}, .calibrations = {"x"}};
}

TEST(PreparedFiles, ArriveAsTheyWere) {
  const auto good = parse_prepared_files(bytes_of(good_files()));
  ASSERT_TRUE(good);
  EXPECT_TRUE(good->problems.empty());
  EXPECT_EQ(good->calibrations, good_files().calibrations);
  EXPECT_EQ(good->map_remark, good_files().map_remark);
  EXPECT_EQ(good->map_H, good_files().map_H);
  EXPECT_EQ(good->quay_W, good_files().quay_W);
  const auto bad = parse_prepared_files(bytes_of(bad_files()));
  ASSERT_TRUE(bad);
  ASSERT_EQ(bad->problems.size(), 2U);
  EXPECT_EQ(to_string(bad->problems[0]), "/a.toml:7: hull.map: gone");
  EXPECT_EQ(to_string(bad->problems[1]), "/b.toml: is empty");
}

TEST(PreparedFiles, ThatWereCutAnywhereOrGrewAreNotTaken) {
  for (const PreparedFiles& files : {good_files(), bad_files()}) {
    const std::string whole = bytes_of(files);
    for (std::size_t length = 0; length < whole.size(); ++length) {
      EXPECT_FALSE(parse_prepared_files(std::string_view(whole).substr(0, length))) << length;
    }
    EXPECT_FALSE(parse_prepared_files(whole + '\0'));
  }
}

TEST(PreparedFiles, ACountBeyondItsBytesTakesNoMemory) {
  const std::string whole = bytes_of(good_files());
  for (std::size_t at = 8; at + 8 <= whole.size(); ++at) {
    std::string lie = whole;
    const std::uint64_t huge = std::numeric_limits<std::uint64_t>::max();
    std::memcpy(lie.data() + at, &huge, sizeof huge);
    const auto parsed = parse_prepared_files(lie);
    EXPECT_FALSE(parsed && parsed->map_H.size() > 2) << at;
  }
}

TEST(PreparedFiles, AreEitherAMapOrProblems) {
  EXPECT_FALSE(parse_prepared_files(bytes_of({})));
  PreparedFiles both = bad_files();
  both.map_H = good_files().map_H;
  EXPECT_FALSE(parse_prepared_files(bytes_of(both)));
}

TEST(PreparedFiles, HoldOnlyPointsThatAMapMayHave) {
  for (const float bad : {std::numeric_limits<float>::quiet_NaN(), std::numeric_limits<float>::infinity(),
                          std::nextafter(kMaxMapCoordinate, 1e9F), -1e30F}) {
    PreparedFiles files = good_files();
    files.map_H[1].y() = bad;
    EXPECT_FALSE(parse_prepared_files(bytes_of(files))) << bad;
  }
}

}  // namespace
}  // namespace hulltrack
