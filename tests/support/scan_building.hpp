// Streams through a ScanBuilder, and when the points that came out were measured.
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <string>
#include <vector>

#include "lidar_drivers/scan_builder.hpp"
#include "tests/support/lidar_stream.hpp"

namespace hulltrack::test {

inline LidarConfig lidar(const std::string& model = "velodyne_vlp16") {
  LidarConfig config;
  config.model = model;
  return config;
}

inline ScanBuilder builder_for(const std::vector<LidarConfig>& lidars, Framing framing = Framing::period,
                               double rate = 10.0) {
  auto built = ScanBuilder::create(lidars, {framing, rate});
  EXPECT_TRUE(built.ok());
  return std::move(built).value();
}

inline void take_all(ScanBuilder& builder, std::vector<Scan>& scans) {
  Scan scan;
  while (builder.take(scan)) scans.push_back(scan);
}

inline std::vector<Scan> build(ScanBuilder& builder, const std::vector<StreamPacket>& packets) {
  std::vector<Scan> scans;
  for (const auto& packet : packets) {
    EXPECT_TRUE(builder.add(0, packet.datagram()).ok());
    take_all(builder, scans);
  }
  builder.finish();
  take_all(builder, scans);
  return scans;
}

/// Measuring times of all points, sorted.
inline std::vector<std::int64_t> point_times(const std::vector<Scan>& scans) {
  std::vector<std::int64_t> times;
  for (const Scan& scan : scans) {
    for (const ScanSegment& segment : scan.segments) {
      for (std::uint32_t i = 0; i < segment.count; ++i) {
        times.push_back(to_ns(segment.time) + scan.points[segment.first + i].dt_ns);
      }
    }
  }
  std::ranges::sort(times);
  return times;
}

inline std::vector<std::int64_t> firing_times(const LidarStream& stream) {
  std::vector<std::int64_t> times;
  for (const auto& hit : stream.returns) times.push_back(to_ns(hit.time));
  std::ranges::sort(times);
  return times;
}

/// Segments follow on each other, and every point was measured within its frame.
inline void expect_consistent(const Scan& scan) {
  std::uint32_t next = 0;
  for (const ScanSegment& segment : scan.segments) {
    EXPECT_EQ(segment.first, next);
    EXPECT_GT(segment.count, 0U);
    next += segment.count;
    for (std::uint32_t i = 0; i < segment.count; ++i) {
      const MeasurementTime time = segment.time + Nanoseconds(scan.points[segment.first + i].dt_ns);
      EXPECT_GE(time, scan.begin);
      EXPECT_LT(time, scan.end);
      EXPECT_GE(time, scan.first_firing);
      EXPECT_LE(time, scan.last_firing);
    }
  }
  EXPECT_EQ(next, scan.points.size());
}

}  // namespace hulltrack::test
