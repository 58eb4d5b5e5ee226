// What the quay says of the joints, one line a frame: the CSV of `hulltrack replay --joints`.
//
// For each joint how much it reads too much, and up to how much wear within the machine's class could hide
// there (ICD 3.1), m and deg, both empty where the scan does not tell; and whether an error of more than 0.6
// m at the quay would be found as well, 1 or 0. Numbers as in frame_csv.hpp.
#pragma once

#include <string>

#include "core/tracking/hull_tracker.hpp"

namespace hulltrack {

inline constexpr const char* kJointCsvHeader =
    "frame,t_ns,travel_off,travel_hidden,travel_far,slew_off,slew_hidden,slew_far,luff_off,luff_hidden,luff_"
    "far";

/// Without a newline.
[[nodiscard]] std::string joint_csv_line(const TrackResult& result);

}  // namespace hulltrack
