#include "daemon/tools/plc_table.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "plc/register_codec.hpp"

namespace hulltrack {
namespace {

using ::testing::Contains;
using ::testing::ElementsAre;
using ::testing::IsEmpty;

std::vector<std::uint16_t> joints(WordOrder order) {
  std::vector<std::uint16_t> registers;
  for (const float value : {123.456F, -87.3F, 0.0F}) {
    const RegisterPair pair = encode_float32(value, order);
    registers.insert(registers.end(), pair.begin(), pair.end());
  }
  return registers;
}

TEST(PlausibleWordOrders, OfJointsThatAreNoRoundFiguresTheirOwnAloneIs) {
  for (const WordOrder order : {WordOrder::abcd, WordOrder::cdab, WordOrder::badc, WordOrder::dcba}) {
    EXPECT_THAT(plausible_word_orders(joints(order)), ElementsAre(order));
  }
}

TEST(PlausibleWordOrders, TheRightOneIsAmongThemWhateverStandsThere) {
  for (const float value : {3.5F, 90.0F, -1.0F, 0.001F}) {
    EXPECT_THAT(plausible_word_orders(encode_float32(value, WordOrder::cdab)), Contains(WordOrder::cdab));
  }
}

TEST(PlausibleWordOrders, NothingIsSaidOfZerosAndWholeNumbersAreNoFloats) {
  EXPECT_THAT(plausible_word_orders(std::vector<std::uint16_t>(6, 0)), IsEmpty());
  EXPECT_THAT(plausible_word_orders(std::vector<std::uint16_t>{0x7FFF, 0xFFFF}), IsEmpty());
}

}  // namespace
}  // namespace hulltrack
