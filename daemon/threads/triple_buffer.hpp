// The newest complete value, handed from one thread to another without copying and without waiting.
//
// Three slots: the producer fills one, the consumer reads one, the third holds the newest published
// value. Publishing over a value that nobody took drops it, and says so: the newest scan wins, an older
// one is counted, never queued. Slots are reused, so a T that keeps its capacity stops allocating.
// Thread rule: one producer thread (writable, publish), one consumer thread (take). Cost: one atomic
// exchange. Failure: none.
#pragma once

#include <array>
#include <atomic>
#include <cstdint>

namespace hulltrack {

template <typename T>
class TripleBuffer {
 public:
  /// The producer's slot; holds an arbitrary old value.
  [[nodiscard]] T& writable() { return slots_[producer_]; }

  /// Makes the producer's slot the newest value. True if the one it replaces was never taken.
  bool publish() {
    const std::uint8_t previous =
        shared_.exchange(static_cast<std::uint8_t>(producer_ | kFresh), std::memory_order_acq_rel);
    producer_ = previous & kIndex;
    return (previous & kFresh) != 0;
  }

  /// The newest value not taken before, or nullptr. Valid until the next take().
  [[nodiscard]] T* take() {
    if (!has_fresh()) {
      return nullptr;
    }
    consumer_ = shared_.exchange(consumer_, std::memory_order_acq_rel) & kIndex;
    return &slots_[consumer_];
  }

  /// Whether take() would give a value now. Any thread.
  [[nodiscard]] bool has_fresh() const { return (shared_.load(std::memory_order_acquire) & kFresh) != 0; }

 private:
  static constexpr std::uint8_t kIndex = 3;
  static constexpr std::uint8_t kFresh = 4;

  std::array<T, 3> slots_{};
  std::uint8_t producer_ = 0;
  std::uint8_t consumer_ = 1;
  std::atomic<std::uint8_t> shared_{2};
};

}  // namespace hulltrack
