// What a frame and the start-up spend their time on.
//
// The default method's steps one by one, as HullTracker takes them while it tracks and as HullMap takes them
// when it is made. The whole is measured elsewhere, on HullTracker and HullMap themselves: what the parts do
// not add up to is between them.
#pragma once

#include <map>
#include <string>
#include <vector>

#include "core/map/hull_map.hpp"
#include "tests/support/frame_recording.hpp"

namespace hulltrack::bench {

/// CPU ms by part: one a frame, one a start-up.
using Parts = std::map<std::string, std::vector<double>>;

/// Every frame of the recording, decoded already, from the hull's true place on.
void time_frame_parts(const FrameRecording& recording, const HullMap& map, Parts& parts);

void time_map_parts(const Cloud& cloud_H, Parts& parts);

}  // namespace hulltrack::bench
