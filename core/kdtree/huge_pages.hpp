// Memory for large arrays that are read at random places: on huge pages where the system has them.
//
// A tree over two million points spans some 7,000 pages of 4 KiB. That is more than a processor's address
// cache (TLB) holds, so that a search waits for addresses as well as for data. Arrays of at least one huge
// page begin on its boundary, and the kernel is advised to use huge pages (Linux: transparent huge pages,
// "madvise" or "always"). If it declines, the pages are small and nothing else changes.
// Failure: std::bad_alloc.
#pragma once

#include <sys/mman.h>

#include <cstddef>
#include <new>
#include <vector>

namespace hulltrack {

template <typename T>
struct HugePageAllocator {
  using value_type = T;
  static constexpr std::size_t kHugePage = std::size_t{2} << 20;  // x86-64

  HugePageAllocator() = default;
  template <typename U>
  HugePageAllocator(const HugePageAllocator<U>&) {
  }  // NOLINT(google-explicit-constructor): allocators convert

  [[nodiscard]] T* allocate(std::size_t count) {
    const std::size_t bytes = count * sizeof(T);
    void* const memory = ::operator new(bytes, alignment(bytes));
    if (bytes >= kHugePage) {
      madvise(memory, bytes, MADV_HUGEPAGE);
    }
    return static_cast<T*>(memory);
  }
  void deallocate(T* memory, std::size_t count) { ::operator delete(memory, alignment(count * sizeof(T))); }

  bool operator==(const HugePageAllocator&) const { return true; }

 private:
  static std::align_val_t alignment(std::size_t bytes) {
    return std::align_val_t{bytes >= kHugePage ? kHugePage : alignof(T)};
  }
};

template <typename T>
using LargeArray = std::vector<T, HugePageAllocator<T>>;

}  // namespace hulltrack
