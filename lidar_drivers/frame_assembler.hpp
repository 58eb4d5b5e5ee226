// Which frame does a point belong to, and when is a frame complete?
//
// Two frames are open at a time, the current one and the one after it, so that LiDARs may run ahead of one
// another by up to a frame. The current frame is finished when every LiDAR that is sending has delivered
// beyond its end, or 20 ms later. A point is copied once, into the frame of its own firing time; with
// revolution framing a few once more, when the turn's end is told after them. Bounded: at most
// kMaxLidarPoints of a LiDAR in a frame and four finished frames in waiting. Owner: one thread.
#pragma once

#include <cstdint>
#include <deque>
#include <vector>

#include "core/geometry/scan.hpp"
#include "lidar_drivers/decoder.hpp"
#include "lidar_drivers/lidar_config.hpp"

namespace hulltrack {

/// More points of one LiDAR than this in one frame are counted and dropped. The fastest sensors send 5.2
/// million points a second (128 beams, 2048 columns, 10 turns, both returns): 520,000 in a tenth of a second.
inline constexpr std::size_t kMaxLidarPoints = 600'000;

class FrameAssembler {
 public:
  /// Points that found no place.
  struct Refused {
    std::uint32_t late = 0;        // their frame had been handed out
    std::uint32_t over_limit = 0;  // the LiDAR's share of the frame was full
  };

  /// framing.frame_rate_hz in (0, 1000]. Revolution framing: frames end at cut(), or after 250 ms without
  /// one.
  FrameAssembler(const FramingConfig& framing, std::size_t lidars);

  /// Revolution framing: the current frame ends at `boundary`. Call before place() of the datagram concerned.
  void cut(MeasurementTime boundary);

  /// Sorts in the points of a datagram whose last firing was at `last`.
  Refused place(std::size_t lidar, const DecodedPacket& packet, MeasurementTime last);

  /// Counters of the frame being filled. Valid until the next call of another function.
  [[nodiscard]] LidarFrameCounters& counters(std::size_t lidar) { return current_.scan.lidars[lidar]; }

  /// Finishes frames that ended more than 20 ms before `now`.
  void advance(MeasurementTime now);
  /// Finishes what is open. Revolution framing: a turn that no cut ended is left out.
  void finish();

  /// Swaps out the oldest finished frame; false when there is none.
  bool take(Scan& out);

  [[nodiscard]] std::uint64_t frames_overrun() const { return frames_overrun_; }
  [[nodiscard]] std::uint64_t clock_steps() const { return clock_steps_; }

 private:
  /// scan.begin and scan.end are the frame's limits, end not included.
  struct Frame {
    Scan scan;
    std::int64_t number = 0;
    bool used = false;  // a datagram had a firing in it
  };
  struct Progress {
    bool seen = false;
    MeasurementTime newest{};  // last firing delivered
  };

  void start(MeasurementTime begin, std::int64_t number);
  void open_next();
  void hand_on();
  void make_room(MeasurementTime first);
  std::uint32_t place_in(Frame& frame, std::size_t lidar, const DecodedPacket& packet, MeasurementTime last);
  void close_current();
  void close_complete();
  void reset(Frame& frame, MeasurementTime begin, std::int64_t number) const;

  Framing framing_;
  Nanoseconds span_;  // period framing: the period; revolution framing: the longest wait for a cut
  bool started_ = false;
  MeasurementTime anchor_{};  // period framing: begin of frame 0
  Frame current_;
  Frame next_;
  std::vector<Progress> progress_;  // one a LiDAR
  MeasurementTime newest_{};
  std::deque<Scan> finished_;
  std::vector<Scan> spare_;  // buffers to use again
  std::uint64_t frames_overrun_ = 0;
  std::uint64_t clock_steps_ = 0;
};

}  // namespace hulltrack
