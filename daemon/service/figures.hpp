// What happened lately, in sums: the raw material of the status line and the minute's summary.
//
// Threads add what they did; the main thread takes the sums and starts a new window. Sums merge, so a
// minute is sixty seconds added up. Milliseconds and metres. Thread rule: FigureBoard from any thread.
#pragma once

#include <algorithm>
#include <cstdint>
#include <mutex>
#include <optional>

#include "core/base/time.hpp"
#include "core/tracking/motion_products.hpp"

namespace hulltrack {

/// Mean and worst of a quantity that is never negative.
struct Spread {
  std::uint64_t count = 0;
  double sum = 0.0;
  double worst = 0.0;

  void add(double value) { add({1, value, value}); }
  void add(const Spread& more) {
    count += more.count;
    sum += more.sum;
    worst = std::max(worst, more.worst);
  }
  [[nodiscard]] double mean() const { return count > 0 ? sum / static_cast<double>(count) : 0.0; }
};

/// How the hull lay when it was last found healthy.
struct HullFigures {
  SteadyTime when;
  MotionProducts motion;  // motion.now is known
  double bend = 0.0;      // m, + sag
  double sigma_bend = -1.0;
};

struct Figures {
  std::uint64_t frames = 0;
  std::uint64_t healthy_frames = 0;
  std::uint64_t frames_dropped = 0;  // processing fell behind
  Spread q1_m;
  Spread processing_ms;  // of the tracking code alone
  Spread latency_ms;     // last packet received to registers written, the wait for joints included
  std::uint64_t polls = 0;
  std::uint64_t polls_failed = 0;
  Spread round_trip_ms;  // of answered polls
  std::uint64_t writes_failed = 0;
  Spread write_gap_ms;  // between successful writes
  std::uint64_t packets = 0;
  std::uint64_t packets_lost = 0;
  std::uint64_t packets_refused = 0;  // malformed or from a foreign sender
  std::optional<HullFigures> hull;    // the newest, where all else are sums

  void add(const Figures& more) {
    frames += more.frames;
    healthy_frames += more.healthy_frames;
    frames_dropped += more.frames_dropped;
    q1_m.add(more.q1_m);
    processing_ms.add(more.processing_ms);
    latency_ms.add(more.latency_ms);
    polls += more.polls;
    polls_failed += more.polls_failed;
    round_trip_ms.add(more.round_trip_ms);
    writes_failed += more.writes_failed;
    write_gap_ms.add(more.write_gap_ms);
    packets += more.packets;
    packets_lost += more.packets_lost;
    packets_refused += more.packets_refused;
    if (more.hull) {
      hull = more.hull;
    }
  }
};

class FigureBoard {
 public:
  void add(const Figures& more) {
    const std::lock_guard lock(mutex_);
    window_.add(more);
  }
  /// Everything added since the last call.
  [[nodiscard]] Figures take() {
    const std::lock_guard lock(mutex_);
    const Figures taken = window_;
    window_ = {};
    return taken;
  }

 private:
  std::mutex mutex_;
  Figures window_;
};

}  // namespace hulltrack
