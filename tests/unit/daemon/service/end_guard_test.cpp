// The end of a process that takes too long: noticed, and only then.
#include "daemon/service/end_guard.hpp"

#include <gtest/gtest.h>

#include <atomic>
#include <future>

namespace hulltrack {
namespace {

TEST(EndGuard, ActsWhenTheEndDoesNotCome) {
  std::promise<void> acted;
  const EndGuard guard(std::chrono::milliseconds(1), [&] { acted.set_value(); });
  EXPECT_EQ(acted.get_future().wait_for(std::chrono::minutes(1)), std::future_status::ready);
}

TEST(EndGuard, DoesNotActNorWaitWhenTheEndComes) {
  std::atomic<bool> acted = false;
  {
    const EndGuard guard(std::chrono::hours(1), [&] { acted = true; });
  }
  EXPECT_FALSE(acted);
}

}  // namespace
}  // namespace hulltrack
