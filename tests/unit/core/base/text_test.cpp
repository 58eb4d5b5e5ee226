#include "core/base/text.hpp"

#include <gtest/gtest.h>

namespace hulltrack {
namespace {

TEST(FormatText, IsAsLongAsItNeedsToBe) {
  const std::string word(5000, 'x');
  EXPECT_EQ(format_text("%s %d", word.c_str(), 7), word + " 7");
  EXPECT_EQ(format_text("%s", ""), "");
}

TEST(Counted, OnlyOneIsSingular) {
  EXPECT_EQ(counted(0, "LiDAR"), "0 LiDARs");
  EXPECT_EQ(counted(1, "LiDAR"), "1 LiDAR");
  EXPECT_EQ(counted(2, "LiDAR"), "2 LiDARs");
  EXPECT_EQ(counted(21, "write block"), "21 write blocks");
}

}  // namespace
}  // namespace hulltrack
