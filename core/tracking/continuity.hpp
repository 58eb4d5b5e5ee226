// Does the pose follow from the last ones as that of a moored hull does?
//
// Checks of health.hpp: they change the memory and add objections. Metres, radians. No failure.
#pragma once

#include "core/tracking/frame_findings.hpp"
#include "core/tracking/health.hpp"
#include "core/tracking/objections.hpp"

namespace hulltrack {

/// Compares the pose with the last accepted one. If the hull could have moved by kUnseen since then, that
/// pose is forgotten and `unique` ends. If the hull moved or turned more than a moored one can: degraded.
void check_continuity(HealthMemory& memory, const FrameFindings& e, Objections& objections);

/// Degraded while some part of the hull is faster than hull.max_speed by her last poses, lost when she has
/// run away (kLongestRun).
void check_speed(const HealthLimits& limits, HealthMemory& memory, MeasurementTime time,
                 Objections& objections);

}  // namespace hulltrack
