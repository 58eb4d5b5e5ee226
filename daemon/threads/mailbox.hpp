// The latest value of something small that one thread knows and others want to read.
//
// Any number of readers; an unread value is simply replaced. For plain values whose copy is short: the
// lock is held for one copy. Before the first put() the value is T{}. Failure: none.
#pragma once

#include <mutex>
#include <utility>

namespace hulltrack {

template <typename T>
class Mailbox {
 public:
  void put(T value) {
    const std::lock_guard lock(mutex_);
    value_ = std::move(value);
  }

  [[nodiscard]] T get() const {
    const std::lock_guard lock(mutex_);
    return value_;
  }

 private:
  mutable std::mutex mutex_;
  T value_{};
};

}  // namespace hulltrack
