#include "lidar_drivers/frame_assembler.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <iterator>
#include <span>
#include <utility>

namespace hulltrack {

namespace {

/// A LiDAR this far behind the others is not waited for.
constexpr Nanoseconds kGrace = std::chrono::milliseconds(20);
/// Slower than any LiDAR turns.
constexpr Nanoseconds kLongestRevolution = std::chrono::milliseconds(250);
/// Time running back by more than this is a clock that was set, not a late datagram.
constexpr Nanoseconds kClockStep = std::chrono::seconds(2);
constexpr std::size_t kFinishedKept = 4;

std::int64_t floor_divide(std::int64_t a, std::int64_t b) { return a / b - (a % b < 0 ? 1 : 0); }

/// The segment of `points`, which are some of those of `whole`; their times are made to count from its
/// middle.
ScanSegment centred(const ScanSegment& whole, std::span<LidarPoint> points, std::uint32_t first) {
  const auto [earliest, latest] = std::ranges::minmax(points, {}, &LidarPoint::dt_ns);
  const std::int32_t middle = earliest.dt_ns + (latest.dt_ns - earliest.dt_ns) / 2;
  for (LidarPoint& point : points) point.dt_ns -= middle;
  return {whole.time + Nanoseconds(middle), first, static_cast<std::uint32_t>(points.size()), whole.lidar};
}

}  // namespace

FrameAssembler::FrameAssembler(const FramingConfig& framing, std::size_t lidars)
    : framing_(framing.framing),
      span_(framing.framing == Framing::period ? Nanoseconds(std::llround(1e9 / framing.frame_rate_hz))
                                               : kLongestRevolution),
      progress_(lidars) {
  assert(framing.frame_rate_hz > 0.0 && framing.frame_rate_hz <= 1000.0);
  start({}, 0);
  started_ = false;
}

void FrameAssembler::start(MeasurementTime begin, std::int64_t number) {
  started_ = true;
  anchor_ = begin - number * span_;
  reset(current_, begin, number);
  open_next();
}

void FrameAssembler::reset(Frame& frame, MeasurementTime begin, std::int64_t number) const {
  frame.number = number;
  frame.used = false;
  frame.scan.clear();
  frame.scan.lidars.resize(progress_.size());
  frame.scan.frame_number = static_cast<std::uint32_t>(number);
  frame.scan.begin = begin;
  frame.scan.end = begin + span_;
  frame.scan.first_firing = frame.scan.last_firing = begin;
  frame.scan.last_received = {};
}

void FrameAssembler::open_next() { reset(next_, current_.scan.end, current_.number + 1); }

void FrameAssembler::cut(MeasurementTime boundary) {
  if (!started_ || boundary <= current_.scan.begin) return;
  while (boundary >= current_.scan.end) {
    if (!current_.used && !next_.used) return;
    close_current();
  }
  if (boundary <= current_.scan.begin || next_.used) return;
  current_.scan.end = boundary;
  open_next();
  hand_on();
}

/// Another LiDAR may have been ahead of the one that tells where a turn ends: what it measured after the end
/// goes from the current frame to the next one. That is among the newest datagrams, so the rest stays.
void FrameAssembler::hand_on() {
  Scan& scan = current_.scan;
  if (!current_.used || scan.last_firing < scan.end) return;
  current_.used = scan.first_firing < scan.end;
  next_.used = true;
  next_.scan.first_firing = std::max(scan.first_firing, scan.end);
  next_.scan.last_firing = std::exchange(scan.last_firing, scan.end - Nanoseconds(1));

  const auto time_of = [](const ScanSegment& segment, const LidarPoint& point) {
    return segment.time + Nanoseconds(point.dt_ns);
  };
  const auto reaches_beyond = [&](const ScanSegment& segment) {
    const auto points = std::span(scan.points).subspan(segment.first, segment.count);
    return std::ranges::any_of(points,
                               [&](const LidarPoint& point) { return time_of(segment, point) >= scan.end; });
  };
  const auto first = std::ranges::find_if(scan.segments, reaches_beyond);
  if (first == scan.segments.end()) return;
  const std::uint32_t kept = first->first;
  const std::vector<ScanSegment> segments(first, scan.segments.end());
  const std::vector<LidarPoint> points(scan.points.begin() + kept, scan.points.end());
  scan.segments.erase(first, scan.segments.end());
  scan.points.resize(kept);
  for (const ScanSegment& segment : segments) {
    const auto all = std::span(points).subspan(segment.first - kept, segment.count);
    for (Scan* to : {&current_.scan, &next_.scan}) {
      const auto begin = static_cast<std::uint32_t>(to->points.size());
      std::ranges::copy_if(all, std::back_inserter(to->points), [&](const LidarPoint& point) {
        return (time_of(segment, point) < scan.end) == (to == &scan);
      });
      const auto count = static_cast<std::uint32_t>(to->points.size()) - begin;
      if (count > 0) to->segments.push_back(centred(segment, std::span(to->points).subspan(begin), begin));
      LidarFrameCounters& counters = to->lidars[segment.lidar];
      if (to == &scan) {
        counters.packets -= count == 0 ? 1 : 0;
        counters.points -= segment.count - count;
      } else {
        counters.packets += count == 0 ? 0 : 1;
        counters.points += count;
      }
    }
  }
}

FrameAssembler::Refused FrameAssembler::place(std::size_t lidar, const DecodedPacket& packet,
                                              MeasurementTime last) {
  assert(lidar < progress_.size());
  const MeasurementTime first = last - packet.duration;
  if (!started_) start(first, 0);
  make_room(first);

  Refused refused;
  if (first < current_.scan.begin) {
    refused.late =
        static_cast<std::uint32_t>(std::ranges::count_if(packet.points, [&](const LidarPoint& point) {
          return last + Nanoseconds(point.dt_ns) < current_.scan.begin;
        }));
  }
  MeasurementTime placed_until = current_.scan.begin;
  for (;;) {
    for (Frame* frame : {&current_, &next_}) {
      if (frame->scan.begin < placed_until) continue;
      if (first < frame->scan.end && last >= frame->scan.begin) {
        refused.over_limit += place_in(*frame, lidar, packet, last);
      }
      placed_until = frame->scan.end;
    }
    if (last < next_.scan.end) break;
    close_current();  // a datagram longer than a frame: the sensor leaves a sector out
  }
  Progress& progress = progress_[lidar];
  progress.newest = progress.seen ? std::max(progress.newest, last) : last;
  progress.seen = true;
  newest_ = std::max(newest_, last);
  close_complete();
  return refused;
}

void FrameAssembler::make_room(MeasurementTime first) {
  if (first + kClockStep < current_.scan.begin) {
    finish();
    ++clock_steps_;
    newest_ = {};
    for (Progress& progress : progress_) progress = {};
    start(first, current_.number);
    return;
  }
  while (first >= next_.scan.end) {
    if (current_.used || next_.used) {
      close_current();
    } else if (framing_ == Framing::period) {
      const std::int64_t number = floor_divide((first - anchor_).count(), span_.count());
      reset(current_, anchor_ + number * span_, number);
      open_next();
      return;
    } else {
      start(first, current_.number);
      return;
    }
  }
}

std::uint32_t FrameAssembler::place_in(Frame& frame, std::size_t lidar, const DecodedPacket& packet,
                                       MeasurementTime last) {
  std::uint32_t over_limit = 0;
  Scan& scan = frame.scan;
  const MeasurementTime from = std::max(last - packet.duration, scan.begin);
  const MeasurementTime to = std::min(last, scan.end - Nanoseconds(1));
  const MeasurementTime middle = from + (to - from) / 2;
  const auto to_middle = static_cast<std::int32_t>((last - middle).count());
  const std::int64_t from_dt = (from - last).count();
  const std::int64_t to_dt = (to - last).count();
  LidarFrameCounters& counters = scan.lidars[lidar];
  const auto begin = static_cast<std::uint32_t>(scan.points.size());
  const std::size_t full = begin + kMaxLidarPoints - counters.points;
  for (const LidarPoint& point : packet.points) {
    if (point.dt_ns < from_dt || point.dt_ns > to_dt) continue;
    if (scan.points.size() >= full) {
      ++over_limit;
      continue;
    }
    scan.points.push_back(point);
    scan.points.back().dt_ns += to_middle;
  }
  const auto count = static_cast<std::uint32_t>(scan.points.size()) - begin;
  if (count > 0) scan.segments.push_back({middle, begin, count, static_cast<std::uint16_t>(lidar)});
  scan.first_firing = frame.used ? std::min(scan.first_firing, from) : from;
  scan.last_firing = frame.used ? std::max(scan.last_firing, to) : to;
  frame.used = true;
  ++counters.packets;
  counters.points += count;
  counters.points_over_limit += over_limit;
  return over_limit;
}

void FrameAssembler::close_complete() {
  while (current_.used || next_.used) {
    const MeasurementTime end = current_.scan.end;
    const bool waiting = std::ranges::any_of(progress_, [&](const Progress& progress) {
      return progress.seen && progress.newest < end && newest_ - progress.newest <= kGrace;
    });
    if (newest_ < end || waiting) return;
    close_current();
  }
}

void FrameAssembler::advance(MeasurementTime now) {
  while ((current_.used || next_.used) && now - kGrace >= current_.scan.end) close_current();
}

void FrameAssembler::finish() {
  while (current_.used || next_.used) {
    const bool unfinished_turn = framing_ == Framing::revolution && newest_ < current_.scan.end;
    if (unfinished_turn) current_.used = false;
    close_current();
  }
}

void FrameAssembler::close_current() {
  if (current_.used) {
    finished_.push_back(std::move(current_.scan));
    if (finished_.size() > kFinishedKept) {
      spare_.push_back(std::move(finished_.front()));
      finished_.pop_front();
      ++frames_overrun_;
    }
    current_.scan = Scan{};
    if (!spare_.empty()) {
      current_.scan = std::move(spare_.back());
      spare_.pop_back();
    }
  }
  std::swap(current_, next_);
  open_next();
}

bool FrameAssembler::take(Scan& out) {
  if (finished_.empty()) return false;
  std::swap(out, finished_.front());
  if (spare_.size() < kFinishedKept) spare_.push_back(std::move(finished_.front()));
  finished_.pop_front();
  return true;
}

}  // namespace hulltrack
