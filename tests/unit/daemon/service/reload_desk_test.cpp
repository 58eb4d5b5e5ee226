// Asking for a reload: whoever asks is answered, whatever becomes of the other side.
#include "daemon/service/reload_desk.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <poll.h>

#include <future>

#include "tests/support/temp_folder.hpp"

namespace hulltrack {
namespace {

using testing::HasSubstr;

constexpr Nanoseconds kLong = std::chrono::minutes(1);

class ReloadDeskTest : public testing::Test {
 protected:
  std::future<ReloadAnswer> ask() {
    return std::async(std::launch::async, [this] { return ask_for_reload(folder.path(), kLong); });
  }
  /// Waits until somebody has asked.
  static void await(ReloadDesk& desk) {
    pollfd entry{desk.fd(), POLLIN, 0};
    ASSERT_EQ(poll(&entry, 1, 60'000), 1);
    ASSERT_TRUE(desk.take_requests());
  }
  test::TempFolder folder;
};

TEST_F(ReloadDeskTest, EverybodyWhoAskedIsTold) {
  ReloadDesk desk(folder.path());
  EXPECT_FALSE(desk.take_requests());
  auto first = ask();
  await(desk);
  auto second = ask();
  await(desk);
  desk.answer(false, "hull.map: gone\nrefused\n");
  for (auto* asked : {&first, &second}) {
    const ReloadAnswer answer = asked->get();
    EXPECT_FALSE(answer.reloaded);
    EXPECT_EQ(answer.text, "hull.map: gone\nrefused\n");
  }
  auto third = ask();
  await(desk);
  desk.answer(true, "done\n");
  EXPECT_TRUE(third.get().reloaded);
}

TEST_F(ReloadDeskTest, TheEndOfTheServiceIsAnAnswer) {
  std::optional<ReloadDesk> desk(std::in_place, folder.path());
  auto asked = ask();
  await(*desk);
  desk.reset();
  const ReloadAnswer answer = asked.get();
  EXPECT_FALSE(answer.reloaded);
  EXPECT_THAT(answer.text, HasSubstr("ends"));
}

TEST_F(ReloadDeskTest, NobodyToAskIsToldAtOnce) {
  EXPECT_THAT(ask_for_reload(folder.path(), kLong).text, HasSubstr("does the service run?"));
  { const ReloadDesk gone(folder.path()); }  // leaves its socket behind, as a service that was killed
  EXPECT_THAT(ask_for_reload(folder.path(), kLong).text, HasSubstr("does the service run?"));
  ReloadDesk next(folder.path());
  auto asked = ask();
  await(next);
  next.answer(true, "");
  EXPECT_TRUE(asked.get().reloaded);
}

TEST_F(ReloadDeskTest, PatienceEnds) {
  const ReloadDesk desk(folder.path());
  EXPECT_THAT(ask_for_reload(folder.path(), std::chrono::milliseconds(1)).text, HasSubstr("no answer"));
}

TEST_F(ReloadDeskTest, AnAnswerThatIsTooLongArrivesCut) {
  ReloadDesk desk(folder.path());
  auto asked = ask();
  await(desk);
  desk.answer(true, std::string(1'000'000, 'x'));
  const ReloadAnswer answer = asked.get();
  EXPECT_TRUE(answer.reloaded);
  EXPECT_GT(answer.text.size(), 10'000U);
}

TEST(ReloadDesk, WithoutAFolderNobodyCanAsk) {
  ReloadDesk desk(std::nullopt);
  EXPECT_EQ(desk.fd(), -1);
  EXPECT_FALSE(desk.take_requests());
}

}  // namespace
}  // namespace hulltrack
