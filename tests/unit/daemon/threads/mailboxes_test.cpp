#include <gtest/gtest.h>

#include <array>
#include <thread>

#include "daemon/service/joint_feed.hpp"
#include "daemon/threads/doorbell.hpp"
#include "daemon/threads/event_bits.hpp"
#include "daemon/threads/mailbox.hpp"

namespace hulltrack {
namespace {

SteadyTime now() { return std::chrono::steady_clock::now(); }

JointSample sample_at(std::int64_t ns) {
  return {measurement_time_from_ns(ns), {.d_x = static_cast<double>(ns), .theta_r = 0.0, .theta_p = 0.0}};
}

TEST(Mailbox, GivesTheLatestValueToEveryReader) {
  Mailbox<int> box;
  EXPECT_EQ(box.get(), 0);
  box.put(3);
  box.put(4);
  EXPECT_EQ(box.get(), 4);
  EXPECT_EQ(box.get(), 4);
}

TEST(Mailbox, NeverGivesAHalfWrittenValue) {
  Mailbox<std::array<int, 32>> box;
  std::jthread writer([&](std::stop_token stop) {
    for (int value = 0; !stop.stop_requested(); ++value) {
      std::array<int, 32> cells{};
      cells.fill(value);
      box.put(cells);
    }
  });
  for (int look = 0; look < 2000; ++look) {
    const auto cells = box.get();
    for (const int cell : cells) {
      ASSERT_EQ(cell, cells.front());
    }
  }
}

TEST(Doorbell, RemembersARingThatCameBeforeTheWait) {
  Doorbell bell;
  bell.ring();
  bell.ring();
  EXPECT_TRUE(bell.wait_until(now() + std::chrono::hours(1)));
  EXPECT_FALSE(bell.wait_until(now())) << "two rings before one look count as one";
}

TEST(Doorbell, WakesAWaitingThread) {
  Doorbell bell;
  std::jthread ringer([&] { bell.ring(); });
  EXPECT_TRUE(bell.wait_until(now() + std::chrono::hours(1)));
}

TEST(JointFeed, HandsEverySampleOverOnceInOrder) {
  JointFeed feed;
  JointHistory history;
  for (std::int64_t ns = 1; ns <= 5; ++ns) {
    feed.push(sample_at(ns));
  }
  feed.drain_into(history);
  feed.drain_into(history);
  EXPECT_EQ(history.size(), 5U);
  EXPECT_EQ(history.newest()->joints.d_x, 5.0);
}

TEST(JointFeed, KeepsTheNewestWhenNobodyDrains) {
  JointFeed feed;
  const auto pushed = static_cast<std::int64_t>(JointFeed::kCapacity) + 10;
  for (std::int64_t ns = 1; ns <= pushed; ++ns) {
    feed.push(sample_at(ns));
  }
  JointHistory history(2 * JointFeed::kCapacity);
  feed.drain_into(history);
  EXPECT_EQ(history.size(), JointFeed::kCapacity);
  EXPECT_EQ(history.at(measurement_time_from_ns(10)).lookup, JointHistory::Lookup::before_oldest);
  EXPECT_EQ(history.at(measurement_time_from_ns(11)).lookup, JointHistory::Lookup::ok);
}

TEST(EventBits, CollectsWhatSeveralThreadsRaisedExactlyOnce) {
  EventBits events;
  {
    std::jthread rx([&] { events.raise(fault::foreign_packets); });
    std::jthread track([&] { events.raise(fault::frame_dropped); });
  }
  EXPECT_EQ(events.collect(), fault::foreign_packets | fault::frame_dropped);
  EXPECT_EQ(events.collect(), 0);
}

}  // namespace
}  // namespace hulltrack
