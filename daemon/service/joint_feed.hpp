// Joint samples on their way from the thread that reads the PLC to the thread that tracks.
//
// Every sample counts here (scans are interpolated between them), so it is a queue, bounded: a consumer
// that stopped loses the oldest. Thread rule: one thread pushes, one drains. Cost: a short lock.
#pragma once

#include <cstddef>
#include <deque>
#include <mutex>

#include "core/kinematics/joint_history.hpp"

namespace hulltrack {

class JointFeed {
 public:
  /// 1024 samples at 20 ms are 20 s, as much as a JointHistory keeps.
  static constexpr std::size_t kCapacity = 1024;

  void push(const JointSample& sample) {
    const std::lock_guard lock(mutex_);
    samples_.push_back(sample);
    if (samples_.size() > kCapacity) {
      samples_.pop_front();
    }
  }

  /// Moves everything pushed so far into `history`.
  void drain_into(JointHistory& history) {
    const std::lock_guard lock(mutex_);
    for (const JointSample& sample : samples_) {
      history.add(sample);
    }
    samples_.clear();
  }

 private:
  std::mutex mutex_;
  std::deque<JointSample> samples_;
};

}  // namespace hulltrack
