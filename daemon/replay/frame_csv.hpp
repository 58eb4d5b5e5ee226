// One line a frame: the per-frame CSV of `hulltrack replay` (ICD 4.2).
//
// m and deg; numbers with the shortest text that reads back equal, so that two runs compare byte for byte.
// x..yaw are empty when nothing was registered, q1..rms when there are no metrics, ms without a timing. After
// ms: draft..surge_rate (m, deg; m/h, deg/h, surge_rate m/min) are empty where unknown, so are bend and
// sigma_bend (m), the upper triangle of the covariance, row by row (rad, m), and q1_expected (m). The last
// column is the reason, quoted, for a health of 0, in the log's words.
#pragma once

#include <optional>
#include <string>

#include "core/tracking/hull_tracker.hpp"

namespace hulltrack {

inline constexpr const char* kFrameCsvHeader =
    "frame,t_ns,state,health,faults,x,y,z,roll,pitch,yaw,q1,mean,median,q3,rms,matched,sigma_t,sigma_r,"
    "iterations,ms,"
    "draft,heel,trim,surge,draft_rate,heel_rate,trim_rate,surge_rate,bend,sigma_bend,"
    "c_rx_rx,c_rx_ry,c_rx_rz,c_rx_x,c_rx_y,c_rx_z,c_ry_ry,c_ry_rz,c_ry_x,c_ry_y,c_ry_z,"
    "c_rz_rz,c_rz_x,c_rz_y,c_rz_z,c_x_x,c_x_y,c_x_z,c_y_y,c_y_z,c_z_z,"
    "q1_expected,reason";

/// Without a newline.
[[nodiscard]] std::string frame_csv_line(const TrackResult& result, std::optional<double> processing_ms);

}  // namespace hulltrack
