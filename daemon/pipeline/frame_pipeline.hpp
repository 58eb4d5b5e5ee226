// One scan to one report: the code that the live service and `hulltrack replay` share.
//
// It adds what the drivers counted to the tracker's faults and measures how long it all took. Time enters
// only as that duration: the report's poses and states depend on the inputs alone. Thread rule: one owner.
// Failure: none, states and faults instead.
#pragma once

#include <memory>
#include <vector>

#include "core/tracking/hull_tracker.hpp"
#include "daemon/config/config.hpp"

namespace hulltrack {

struct FrameReport {
  TrackResult track;
  Nanoseconds processing{0};  // this call's duration
};

class FramePipeline {
 public:
  /// `map` and `quay` as for HullTracker.
  FramePipeline(const Config& config, std::shared_ptr<const HullMap> map,
                std::shared_ptr<const QuayMap> quay = nullptr);

  [[nodiscard]] FrameReport process(const Scan& scan, const JointHistory& joints, const FrameInputs& inputs);

 private:
  HullTracker tracker_;
};

}  // namespace hulltrack
