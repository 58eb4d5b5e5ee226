// A Scan: what every LiDAR measured in one frame period, still in each sensor's own frame L.
//
// Shape: points of one datagram lie together in a segment; segments are in order of arrival per
// LiDAR. A frame boundary inside a datagram splits it into two segments of two scans.
// Units: metres in L (x forward, y left, z up), nanoseconds. Points without a return are absent.
// Thread rule: filled by one thread, handed over whole, then read only.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "core/base/time.hpp"

namespace hulltrack {

/// One return in L. Its measuring time is its segment's time + dt_ns.
struct LidarPoint {
  float x, y, z;            // m
  std::int32_t dt_ns;       // offset to the segment's reference time; may be negative
  std::uint16_t intensity;  // vendor's reflectivity scale
  std::uint8_t channel;     // 0-based laser (Ouster: pixel row)
  std::uint8_t echo;        // 0 = the only or the last return, 1 = another one of the same firing
};

/// The points of one datagram (or the part of it on one side of a frame boundary).
struct ScanSegment {
  MeasurementTime time;  // middle of the segment's firings; the joints are taken at this time
  std::uint32_t first;   // index into Scan::points
  std::uint32_t count;
  std::uint16_t lidar;  // index into the configuration's [[lidar]] list
};

/// What the drivers saw of one LiDAR while the frame was collected.
struct LidarFrameCounters {
  std::uint32_t packets = 0;           // decoded datagrams with a firing in the frame, returns or not
  std::uint32_t packets_lost = 0;      // estimated from sequence, time stamps and azimuth
  std::uint32_t packets_rejected = 0;  // wrong size, foreign sender, bad flag
  std::uint32_t points = 0;
  std::uint32_t points_over_limit = 0;  // beyond the largest frame that is processed: dropped
};

struct Scan {
  std::uint32_t frame_number = 0;  // from 0, +1 a frame, gaps where nothing arrived
  MeasurementTime begin;           // first firing in the frame (period framing: start of period)
  MeasurementTime end;             // last firing in the frame (period framing: end of period)
  MeasurementTime first_firing;    // earliest and latest firing really present
  MeasurementTime last_firing;
  SteadyTime last_received{};  // live, set by the receiver: when the scan was complete; replay: zero
  std::vector<LidarPoint> points;
  std::vector<ScanSegment> segments;
  std::vector<LidarFrameCounters> lidars;  // one per configured LiDAR

  [[nodiscard]] MeasurementTime mid_time() const { return begin + (end - begin) / 2; }
  void clear() {
    points.clear();
    segments.clear();
    lidars.clear();
  }
};

}  // namespace hulltrack
