#include "daemon/service/track_thread.hpp"

#include <algorithm>
#include <utility>

#include "daemon/pipeline/live_time.hpp"

namespace hulltrack {
namespace {

/// Longest sleep without a ring: bounds how seldom the watch hears of this thread.
constexpr std::chrono::milliseconds kLongestWait{100};

}  // namespace

TrackThread::TrackThread(const Config& config, std::shared_ptr<const HullMap> map,
                         std::shared_ptr<const QuayMap> quay, Exchange& exchange, Pulse& pulse)
    : exchange_(exchange),
      pulse_(pulse),
      patience_(JointHistory::kMaxGap + config.plc.latency + config.plc.response_timeout),
      pipeline_(config, std::move(map), std::move(quay)) {}

void TrackThread::run(std::stop_token stop) {
  while (!stop.stop_requested()) {
    pulse_.beat(steady_now());
    if (const Scan* scan = exchange_.scans.take()) {
      const JointHistory::Lookup lookup = await_joints(*scan, stop);
      exchange_.awaiting_joints.store(false, std::memory_order_relaxed);
      // The scan under way when the PLC first answered is no fault: the service is still starting.
      if (sequence_ > 0 || lookup != JointHistory::Lookup::before_oldest) {
        process(*scan);
      }
    } else {
      exchange_.track_bell.wait_until(steady_now() + kLongestWait);
    }
  }
}

JointHistory::Lookup TrackThread::await_joints(const Scan& scan, const std::stop_token& stop) {
  for (;;) {
    const SteadyTime now = steady_now();
    pulse_.beat(now);
    exchange_.joints.drain_into(joints_);
    const JointHistory::Lookup lookup = joints_.covers(scan.first_firing, scan.last_firing);
    // One lost poll must cost no frame its health, so even a newer scan waits its turn until it is certain
    // that no sample brackets this one.
    const std::optional<JointSample> newest = joints_.newest();
    const SteadyTime deadline = live_steady_time(newest ? newest->time : scan.last_firing) + patience_;
    const bool may_come =
        lookup == JointHistory::Lookup::after_newest || lookup == JointHistory::Lookup::empty;
    if (!may_come || now >= deadline || stop.stop_requested()) {
      return lookup;
    }
    exchange_.awaiting_joints.store(true, std::memory_order_relaxed);
    exchange_.track_bell.wait_until(std::min(deadline, now + kLongestWait));
  }
}

void TrackThread::process(const Scan& scan) {
  FrameReport report = pipeline_.process(scan, joints_, inputs());
  const SteadyTime done = steady_now();
  Figures figures;
  figures.frames = 1;
  figures.processing_ms.add(to_milliseconds(report.processing));
  if (report.track.metrics.valid) {
    figures.q1_m.add(report.track.metrics.q1);
  }
  if (report.track.motion.now) {
    figures.hull = {done, report.track.motion, report.track.bend, report.track.sigma_bend};
  }
  exchange_.figures.add(figures);
  exchange_.frame.put(
      {++sequence_, std::move(report.track), scan.last_received, done, scan.first_firing, scan.last_firing});
  exchange_.plc_bell.ring();
}

FrameInputs TrackThread::inputs() {
  const PlcView plc = exchange_.plc.get();
  const bool reacquire = plc.reacquire_edges != std::exchange(reacquire_edges_, plc.reacquire_edges);
  const auto standing = static_cast<Faults>(plc.standing | exchange_.lidars.get().standing);
  return {.hold = plc.hold, .reacquire = reacquire, .standing = standing, .joint_trouble = plc.joint_trouble};
}

}  // namespace hulltrack
