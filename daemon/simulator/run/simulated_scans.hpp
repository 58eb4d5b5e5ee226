// A simulation without files: the scans and joint samples that the drivers would have handed to the tracker.
//
// Bytes go through the real decoder and scan builder; joint samples through the PLC model, with the stated
// latency already subtracted. Times are kEpoch + time since the first firing. For tests and benchmarks.
// Failure: an error of the scan builder, which means that the simulated sensor is not a known model.
#pragma once

#include <vector>

#include "core/base/result.hpp"
#include "core/geometry/scan.hpp"
#include "core/kinematics/joint_history.hpp"
#include "daemon/simulator/run/simulated_berth.hpp"

namespace hulltrack {

/// Frames [first, first + count) of the run, in order; fewer where the run ends. Frame numbers count from
/// `first`'s 0, times are those of the whole run. A frame costs some 15 ms and a core.
[[nodiscard]] Result<std::vector<Scan>> simulated_scans(const SimulatedBerth& berth, int first, int count);

/// Every sample of the run as the service would have believed it: changed heartbeats only.
[[nodiscard]] std::vector<JointSample> simulated_joint_samples(const SimulatedBerth& berth);

}  // namespace hulltrack
