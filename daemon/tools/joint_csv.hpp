// What the quay says of the joints, one line a frame: the CSV of `hulltrack replay --joints`.
//
// For each joint how much it reads too much, and up to how much wear within the machine's class could hide
// there (ICD 3.1), m and deg; both are empty where the scan does not tell, or shows small errors but would not
// find a large one. Numbers as in frame_csv.hpp.
#pragma once

#include <string>

#include "core/tracking/hull_tracker.hpp"

namespace hulltrack {

inline constexpr const char* kJointCsvHeader =
    "frame,t_ns,travel_off,travel_hidden,slew_off,slew_hidden,luff_off,luff_hidden";

/// Without a newline.
[[nodiscard]] std::string joint_csv_line(const TrackResult& result);

}  // namespace hulltrack
