// The thread that tracks: newest scan + joints that bracket it -> one frame's result.
//
// A scan waits for the joint samples after its last packet until they are here or cannot come any more; a
// newer scan waits meanwhile, and replaces one that waits already. It is processed in any case; without
// joints the tracker says so. Thread rule: run() in a thread of its own. Latency: a result is announced at
// once.
#pragma once

#include <memory>
#include <stop_token>

#include "daemon/pipeline/frame_pipeline.hpp"
#include "daemon/service/exchange.hpp"
#include "daemon/threads/thread_watch.hpp"

namespace hulltrack {

class TrackThread {
 public:
  /// References must outlive this object; `map` and `quay` as for HullTracker.
  TrackThread(const Config& config, std::shared_ptr<const HullMap> map, std::shared_ptr<const QuayMap> quay,
              Exchange& exchange, Pulse& pulse);

  void run(std::stop_token stop);

 private:
  /// Gives what the joint history says of the scan in the end.
  JointHistory::Lookup await_joints(const Scan& scan, const std::stop_token& stop);
  void process(const Scan& scan);
  [[nodiscard]] FrameInputs inputs();

  Exchange& exchange_;
  Pulse& pulse_;
  /// The next sample brackets nothing if it was taken kMaxGap after the newest one (ICD 2.1); it was taken
  /// plc.latency before it was asked for, and is here at most a response timeout later.
  Nanoseconds patience_;
  FramePipeline pipeline_;
  JointHistory joints_;
  std::uint32_t reacquire_edges_ = 0;
  std::uint64_t sequence_ = 0;
};

}  // namespace hulltrack
