#include "core/io/plc_csv.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <limits>

#include "tests/support/temp_folder.hpp"

namespace hulltrack {
namespace {

using test::TempFolder;
using ::testing::HasSubstr;

constexpr const char* kHeader = "t_ns,d_x,theta_r,theta_p,heartbeat,command\n";

TEST(PlcCsv, WhatIsWrittenReadsBackBitForBit) {
  const TempFolder folder;
  const auto file = folder.path() / "plc.csv";
  const std::vector<PlcCsvRow> rows = {
      {1'763'820'000'000'000'001, 1.0 / 3.0, -0.1, 1e-17, 65535, 3},
      {1'763'820'000'020'000'000, -499.999999999999, std::numeric_limits<double>::denorm_min(), -0.0, 0,
       65535},
      {std::numeric_limits<std::int64_t>::max(), 1e300, 2.5, 3.0, 4'294'967'295U, 0}};
  auto writer = PlcCsvWriter::create(file);
  ASSERT_TRUE(writer);
  for (const auto& row : rows) {
    ASSERT_TRUE(writer->write(row));
  }
  ASSERT_TRUE(writer->close());

  const auto back = read_plc_csv(file);
  ASSERT_TRUE(back) << back.error().message;
  ASSERT_EQ(back->size(), rows.size());
  for (std::size_t i = 0; i < rows.size(); ++i) {
    EXPECT_EQ((*back)[i].t_ns, rows[i].t_ns);
    EXPECT_EQ((*back)[i].d_x, rows[i].d_x);
    EXPECT_EQ((*back)[i].theta_r_deg, rows[i].theta_r_deg);
    EXPECT_EQ((*back)[i].theta_p_deg, rows[i].theta_p_deg);
    EXPECT_EQ((*back)[i].heartbeat, rows[i].heartbeat);
    EXPECT_EQ((*back)[i].command, rows[i].command);
  }
}

TEST(TruthCsv, WhatIsWrittenReadsBackBitForBit) {
  const TempFolder folder;
  const auto file = folder.path() / "truth.csv";
  auto writer = TruthCsvWriter::create(file);
  ASSERT_TRUE(writer);
  ASSERT_TRUE(writer->write({7, {0.1, -0.2, 1e-9}, {359.9, -1.0 / 7.0, 0.0}, -0.125}));
  ASSERT_TRUE(writer->close());
  EXPECT_THAT(test::read_text(file), HasSubstr("t_ns,x,y,z,roll,pitch,yaw,bend\n7,0.1,-0.2,1e-09,359.9,"));
  const auto back = read_truth_csv(file);
  ASSERT_TRUE(back) << back.error().message;
  EXPECT_EQ(back->front().xyz, Eigen::Vector3d(0.1, -0.2, 1e-9));
  EXPECT_EQ(back->front().rpy_deg, Eigen::Vector3d(359.9, -1.0 / 7.0, 0.0));
  EXPECT_EQ(back->front().bend, -0.125);
}

TEST(TruthCsv, AFileWithoutABendHasAStiffHullAndOneMissingAnythingElseIsRefused) {
  const TempFolder folder;
  const auto stiff = read_truth_csv(folder.file("stiff.csv", "t_ns,x,y,z,roll,pitch,yaw\n7,1,2,3,4,5,6\n"));
  ASSERT_TRUE(stiff) << stiff.error().message;
  EXPECT_EQ(stiff->front().rpy_deg.z(), 6.0);
  EXPECT_EQ(stiff->front().bend, 0.0);
  for (const char* content : {"t_ns,x,y,z,roll,pitch\n7,1,2,3,4,5\n",             // a column short
                              "t_ns,x,y,z,roll,pitch,yaw,be\n7,1,2,3,4,5,6,0\n",  // half a name
                              "t_ns,x,y,z,roll,pitch,yaw,bend,more\n7,1,2,3,4,5,6,0,0\n",
                              "t_ns,x,y,z,roll,pitch,yaw\n7,1,2,3,4,5,6,0\n"})  // a field without a name
    EXPECT_FALSE(read_truth_csv(folder.file("bad.csv", content))) << content;
}

TEST(PlcCsv, AcceptsCarriageReturnsEqualTimesAndAMissingLastNewline) {
  const TempFolder folder;
  const auto file =
      folder.file("plc.csv", "t_ns,d_x,theta_r,theta_p,heartbeat,command\r\n5,1,2,3,4,0\r\n5,1.5,2,3,4,1");
  const auto rows = read_plc_csv(file);
  ASSERT_TRUE(rows) << rows.error().message;
  ASSERT_EQ(rows->size(), 2U);
  EXPECT_EQ(rows->back().d_x, 1.5);
  EXPECT_EQ(rows->back().command, 1);
}

TEST(PlcCsv, BlankLinesMayEndTheFile) {
  const TempFolder folder;
  for (const char* end : {"\n\n", "\n\n\n\n", "\r\n\r\n", "\n\r"}) {
    const auto rows = read_plc_csv(folder.file("plc.csv", std::string(kHeader) + "1,2,3,4,5,0" + end));
    ASSERT_TRUE(rows) << rows.error().message;
    EXPECT_EQ(rows->size(), 1U);
  }
}

struct Broken {
  const char* name;
  std::string content;
  const char* place;  // what follows the file's name
  const char* says;
};

class BrokenPlcCsv : public ::testing::TestWithParam<Broken> {};

TEST_P(BrokenPlcCsv, IsRefusedNamingFileAndLine) {
  const TempFolder folder;
  const auto file = folder.file("plc.csv", GetParam().content);
  const auto rows = read_plc_csv(file);
  ASSERT_FALSE(rows);
  EXPECT_THAT(rows.error().message, ::testing::StartsWith(file.string() + GetParam().place));
  EXPECT_THAT(rows.error().message, HasSubstr(GetParam().says));
}

INSTANTIATE_TEST_SUITE_P(
    Kinds, BrokenPlcCsv,
    ::testing::Values(
        Broken{"empty", "", ": ", "is empty"}, Broken{"no_rows", kHeader, ": ", "no rows"},
        Broken{"wrong_header", "t_ns,x,y\n1,2,3\n",
               ":1: ", "must be `t_ns,d_x,theta_r,theta_p,heartbeat,command`"},
        Broken{"too_few_fields", std::string(kHeader) + "1,2,3,4,5,0\n2,2,3,4,5\n3,2,3,4,5,0\n",
               ":3: ", "has 5 fields, must have 6"},
        Broken{"cut_short", std::string(kHeader) + "1,2,3,4,5,0\n2,2,3", ":3: ", "cut short"},
        Broken{"too_many_fields", std::string(kHeader) + "1,2,3,4,5,0,9\n", ":2: ", "has 7 fields"},
        Broken{"blank_line", std::string(kHeader) + "1,2,3,4,5,0\n\n2,2,3,4,5,0\n",
               ":3: ", "is blank, with more"},
        Broken{"not_a_number", std::string(kHeader) + "1,2,three,4,5,0\n",
               ":2: ", "theta_r is `three`, must be a finite number"},
        Broken{"nan", std::string(kHeader) + "1,nan,3,4,5,0\n", ":2: ", "d_x is `nan`"},
        Broken{"infinity", std::string(kHeader) + "1,2,3,-inf,5,0\n", ":2: ", "theta_p is `-inf`"},
        Broken{"overflow", std::string(kHeader) + "1,2,3,1e999,5,0\n", ":2: ", "theta_p is `1e999`"},
        Broken{"fractional_time", std::string(kHeader) + "1.5,2,3,4,5,0\n",
               ":2: ", "t_ns is `1.5`, must be whole nanoseconds"},
        Broken{"time_overflow", std::string(kHeader) + "9223372036854775808,2,3,4,5,0\n", ":2: ", "t_ns"},
        Broken{"negative_time", std::string(kHeader) + "-1,2,3,4,5,0\n", ":2: ", "negative"},
        Broken{"command_too_large", std::string(kHeader) + "1,2,3,4,5,65536\n", ":2: ", "command is `65536`"},
        Broken{"negative_heartbeat", std::string(kHeader) + "1,2,3,4,-5,0\n", ":2: ", "heartbeat is `-5`"},
        Broken{"trailing_space", std::string(kHeader) + "1,2,3,4,5,0 \n", ":2: ", "command is `0 `"},
        Broken{"nul_byte", std::string(kHeader) + std::string("1,2\0,3,4,5,0\n", 13), ":2: ", "d_x"},
        Broken{"time_backwards", std::string(kHeader) + "1,2,3,4,5,0\n20,2,3,4,5,0\n19,2,3,4,5,0\n",
               ":4: ", "t_ns 19 after 20 in line 3"},
        Broken{"long_line", std::string(kHeader) + std::string(5000, '1') + "\n", ":2: ", "longer than"}),
    [](const auto& kind) { return std::string(kind.param.name); });

TEST(PlcCsv, MissingFileOrFolderIsNamed) {
  const TempFolder folder;
  const auto missing = folder.path() / "none.csv";
  EXPECT_THAT(read_plc_csv(missing).error().message,
              HasSubstr(missing.string() + ": cannot be opened: No such file"));
  EXPECT_THAT(read_truth_csv(folder.path()).error().message, HasSubstr("Is a directory"));
  EXPECT_THAT(PlcCsvWriter::create(folder.path() / "no" / "plc.csv").error().message,
              HasSubstr("cannot be created"));
}

TEST(PlcCsv, AFullDiskIsReported) {
  if (!std::filesystem::exists("/dev/full")) {
    GTEST_SKIP() << "needs /dev/full";
  }
  auto writer = PlcCsvWriter::create("/dev/full");
  ASSERT_TRUE(writer);
  ASSERT_TRUE(writer->write({})) << "still in the buffer";
  const auto closed = writer->close();
  ASSERT_FALSE(closed);
  EXPECT_THAT(closed.error().message, HasSubstr("No space left"));
}

}  // namespace
}  // namespace hulltrack
