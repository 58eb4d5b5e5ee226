// Everything that the threads rx, track and plc hand to each other: the only state they share.
//
// rx -> track: scans, newest wins. plc -> track: joint samples, and how the PLC stands. track -> plc: the
// newest frame's result. rx -> plc: how the LiDARs stand. All -> main: figures and what the registers say.
// Two doorbells wake track and plc. Every member is safe for the threads named beside it.
#pragma once

#include <atomic>
#include <cstdint>
#include <memory>
#include <string>

#include "core/base/status.hpp"
#include "core/geometry/scan.hpp"
#include "core/tracking/hull_tracker.hpp"
#include "daemon/service/figures.hpp"
#include "daemon/service/joint_feed.hpp"
#include "daemon/threads/doorbell.hpp"
#include "daemon/threads/event_bits.hpp"
#include "daemon/threads/mailbox.hpp"
#include "daemon/threads/triple_buffer.hpp"
#include "plc/write_block.hpp"

namespace hulltrack {

/// How the LiDARs stand, as rx knows it.
struct LidarView {
  Faults standing = 0;  // lidar_silent, clock
  bool every_silent = false;
  SteadyTime updated{};  // rx last looked; zero = never
};

/// How the PLC stands, as the plc thread knows it.
struct PlcView {
  bool hold = false;
  std::uint32_t reacquire_edges = 0;  // counted, so that track misses none between two frames
  Faults standing = 0;                // plc_stale, plc_value
  std::string joint_trouble;          // why joint values are not believed; "" if they are
};

/// One frame that track is done with.
struct FrameDone {
  std::uint64_t sequence = 0;  // 1 for the first; 0 = none yet
  TrackResult result;
  SteadyTime last_received{};  // the scan's last packet
  SteadyTime done{};
  MeasurementTime first_firing{}, last_firing{};  // of the scan
};

struct Exchange {
  TripleBuffer<Scan> scans;       // rx produces, track consumes
  JointFeed joints;               // plc pushes, track drains
  Mailbox<LidarView> lidars;      // rx puts, plc and track get
  Mailbox<PlcView> plc;           // plc puts, track gets
  Mailbox<FrameDone> frame;       // track puts, plc gets
  Mailbox<WriteBlock> registers;  // plc puts, main gets
  EventBits events;               // rx raises, plc collects
  FigureBoard figures;            // all add, main takes
  /// No session, and none is being started: set before the plc thread runs.
  std::atomic<bool> out_of_service = false;
  Doorbell track_bell;  // a scan or a joint sample has come
  Doorbell plc_bell;    // a frame is done
  /// track has a scan and waits for its joint samples: what comes meanwhile is not late by its fault.
  std::atomic<bool> awaiting_joints = false;

  /// Hands the scan that rx has written over. True if it replaces one that track was too slow for.
  bool publish_scan() { return scans.publish() && !awaiting_joints.load(std::memory_order_relaxed); }
};

}  // namespace hulltrack
