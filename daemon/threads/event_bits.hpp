// Fault events that happened since somebody last looked: threads raise, the publishing thread collects.
//
// For the event bits of ICD 2.3 only; conditions travel in mailboxes. Lock-free, any thread.
#pragma once

#include <atomic>

#include "core/base/status.hpp"

namespace hulltrack {

class EventBits {
 public:
  void raise(Faults bits) { bits_.fetch_or(bits, std::memory_order_relaxed); }
  /// The events raised since the last call.
  [[nodiscard]] Faults collect() { return bits_.exchange(0, std::memory_order_relaxed); }

 private:
  std::atomic<Faults> bits_{0};
};

}  // namespace hulltrack
