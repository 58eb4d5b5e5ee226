#include "daemon/threads/triple_buffer.hpp"

#include <gtest/gtest.h>

#include <thread>
#include <vector>

namespace hulltrack {
namespace {

TEST(TripleBuffer, GivesNothingBeforeTheFirstPublish) {
  TripleBuffer<int> buffer;
  EXPECT_FALSE(buffer.has_fresh());
  EXPECT_EQ(buffer.take(), nullptr);
}

TEST(TripleBuffer, GivesEveryPublishedValueOnce) {
  TripleBuffer<int> buffer;
  buffer.writable() = 7;
  EXPECT_FALSE(buffer.publish());
  ASSERT_TRUE(buffer.has_fresh());
  EXPECT_EQ(*buffer.take(), 7);
  EXPECT_EQ(buffer.take(), nullptr);
}

TEST(TripleBuffer, NewestWinsAndTheDropIsReported) {
  TripleBuffer<int> buffer;
  buffer.writable() = 1;
  EXPECT_FALSE(buffer.publish());
  buffer.writable() = 2;
  EXPECT_TRUE(buffer.publish());
  EXPECT_EQ(*buffer.take(), 2);
}

TEST(TripleBuffer, ReaderKeepsItsValueWhileTheProducerGoesOn) {
  TripleBuffer<int> buffer;
  buffer.writable() = 1;
  (void)buffer.publish();
  const int* held = buffer.take();
  for (int value = 2; value < 10; ++value) {
    buffer.writable() = value;
    (void)buffer.publish();
  }
  EXPECT_EQ(*held, 1);
  EXPECT_EQ(*buffer.take(), 9);
}

// Every value is whole, the order is kept, and taken + dropped accounts for every value published.
TEST(TripleBuffer, ConcurrentHandOverLosesNothingUncounted) {
  struct Block {
    std::vector<int> cells = std::vector<int>(64, 0);
  };
  constexpr int kValues = 20000;
  TripleBuffer<Block> buffer;
  int dropped = 0;
  std::thread producer([&] {
    for (int value = 1; value <= kValues; ++value) {
      for (int& cell : buffer.writable().cells) {
        cell = value;
      }
      dropped += buffer.publish() ? 1 : 0;
    }
  });
  int taken = 0;
  int newest = 0;
  bool whole = true;
  while (newest < kValues) {
    const Block* block = buffer.take();
    if (block == nullptr) {
      std::this_thread::yield();
      continue;
    }
    ++taken;
    whole = whole && block->cells.front() > newest;
    newest = block->cells.front();
    for (const int cell : block->cells) {
      whole = whole && cell == newest;
    }
  }
  producer.join();
  EXPECT_TRUE(whole);
  EXPECT_EQ(taken + dropped, kValues);
}

}  // namespace
}  // namespace hulltrack
