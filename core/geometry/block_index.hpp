// Which number has the block of cells at (x, y, z), if it has one? For grids that are kept only where
// something is: their memory grows with what is in them, not with how far apart it lies.
//
// A hash table from whole coordinates to the numbers 0, 1, 2, ... in the order in which blocks were added.
// Coordinates within +-kFarthest. No failure: a block that was not added has no number. Thread rule: a plain
// value; any number of threads may find(). Cost: 32 to 64 bytes a block; some 3 ns a find().
#pragma once

#include <cassert>
#include <cstddef>
#include <cstdint>
#include <utility>
#include <vector>

namespace hulltrack {

/// std::floor for |v| < 2^31. The code is built for processors before SSE 4.1 too, where std::floor is a
/// call.
[[nodiscard]] inline int rounded_down(float v) {
  const int towards_zero = static_cast<int>(v);
  return towards_zero - (v < static_cast<float>(towards_zero) ? 1 : 0);
}

class BlockIndex {
 public:
  static constexpr int kFarthest = (1 << 20) - 1;
  static constexpr std::uint32_t kNone = 0xFFFFFFFFU;

  [[nodiscard]] std::size_t size() const { return size_; }
  /// Heap memory that the table holds, bytes.
  [[nodiscard]] std::size_t memory() const { return slots_.capacity() * sizeof(Slot); }

  /// The block's number; the next one, size(), if it has none yet.
  std::uint32_t add(int x, int y, int z) {
    if (2 * (size_ + 1) > slots_.size()) {
      grow();
    }
    Slot& slot = slots_[place_of(key_of(x, y, z))];
    if (slot.number == kNone) {
      slot = {key_of(x, y, z), static_cast<std::uint32_t>(size_++)};
    }
    return slot.number;
  }

  [[nodiscard]] std::uint32_t find(int x, int y, int z) const {
    return slots_[place_of(key_of(x, y, z))].number;
  }

 private:
  struct Slot {
    std::uint64_t key = 0;
    std::uint32_t number = kNone;
  };

  [[nodiscard]] static std::uint64_t key_of(int x, int y, int z) {
    constexpr int kBits = 21;
    const auto part = [](int v) {
      assert(v >= -kFarthest && v <= kFarthest);
      return static_cast<std::uint64_t>(v + kFarthest);
    };
    return (part(x) << (2 * kBits)) | (part(y) << kBits) | part(z);
  }

  /// The slot that holds the key, or the free one where it would be put.
  [[nodiscard]] std::size_t place_of(std::uint64_t key) const {
    const std::size_t mask = slots_.size() - 1;
    // 2^64 / golden ratio spreads neighbouring keys, best in the highest bits, which all of a key's bits
    // reach (Knuth, multiplicative hashing).
    auto at = static_cast<std::size_t>((key * 0x9E3779B97F4A7C15U) >> (64 - bits_));
    while (slots_[at].number != kNone && slots_[at].key != key) {
      at = (at + 1) & mask;
    }
    return at;
  }

  void grow() {
    const std::vector<Slot> old = std::move(slots_);
    slots_.assign(2 * old.size(), {});
    ++bits_;
    for (const Slot& slot : old) {
      if (slot.number != kNone) {
        slots_[place_of(slot.key)] = slot;
      }
    }
  }

  int bits_ = 4;
  std::vector<Slot> slots_ = std::vector<Slot>(std::size_t{1} << bits_);  // at most half full
  std::size_t size_ = 0;
};

}  // namespace hulltrack
