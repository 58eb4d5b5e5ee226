// What do the registers say now? Tracker results, standing conditions and the time -> WriteBlock.
//
// Holds what ICD 2.2 asks to be held: the pose of the last published health 1, the figures of the newest
// frame, each event bit for a second. The health flag falls here by itself when the pose grows older than
// health.max_age_ms, whatever the tracker last said. Asks no clock; the same calls give the same blocks.
// `now` is on measurement time, so a pose's age is now - TrackResult::time, live and in a replay. Thread
// rule: one owner. Cost: constant, no allocation.
#pragma once

#include <array>

#include "core/tracking/hull_tracker.hpp"
#include "plc/write_block.hpp"

namespace hulltrack {

/// What holds at the moment of a write, besides the newest frame.
struct PublicationContext {
  bool stopped = false;         // the last write of a clean stop
  bool out_of_service = false;  // there is no session, and none is being started
  bool every_lidar_silent = false;
  Faults standing = 0;        // conditions: plc_stale, plc_value, lidar_silent, clock, map_unusable
  std::uint16_t command = 0;  // last command word read
};

class Publication {
 public:
  /// How long an event bit stays set (ICD 2.3: at least 1 s; a quarter more for the PLC's own cycle).
  static constexpr Nanoseconds kEventHold = std::chrono::milliseconds(1250);

  explicit Publication(Nanoseconds max_age) : max_age_(max_age) {}

  /// Another configuration is in force, as if the service had started, but the registers go on: the pose
  /// stays and ages, and the frames' numbers rise from the last one.
  void begin_anew(Nanoseconds max_age);

  /// A frame is done. `processing`: last packet received to registers ready.
  void frame(const TrackResult& result, MeasurementTime now, Nanoseconds processing);

  /// Something happened outside a frame: plc_link_lost, foreign_packets, frame_dropped.
  void events(Faults faults, MeasurementTime now);

  /// The block to write now, heartbeats left at 0.
  [[nodiscard]] WriteBlock block(const PublicationContext& context, MeasurementTime now);

 private:
  /// The part of the block that only changes while health is 1.
  struct HealthyPose {
    bool any = false;
    TrackResult result;
  };

  [[nodiscard]] State state(const PublicationContext& context, MeasurementTime now) const;
  [[nodiscard]] Faults faults(const PublicationContext& context, MeasurementTime now) const;

  Nanoseconds max_age_;
  bool any_frame_ = false;           // of the configuration in force
  std::uint32_t frames_before_ = 0;  // of those before it
  TrackResult newest_;
  Nanoseconds processing_{0};
  HealthyPose healthy_;
  std::array<MeasurementTime, 16> event_until_{};
};

}  // namespace hulltrack
