// The service in one line: for `systemctl status`, and once a minute for the log, with the hull in another.
//
// Pure functions of a window's sums and of what the registers say now.
#pragma once

#include <optional>
#include <string>

#include "core/base/time.hpp"
#include "daemon/service/figures.hpp"
#include "plc/write_block.hpp"

namespace hulltrack {

/// "tracking 10.0 Hz, Q1 0.071 m, PLC 2.1 ms, loss 0.0 %"; `window` is how long the figures were
/// collected, > 0.
[[nodiscard]] std::string status_line(const WriteBlock& registers, const Figures& figures,
                                      Nanoseconds window);

/// The same at length: health share, latency, dropped frames, failed polls, refused packets.
[[nodiscard]] std::string summary_line(const WriteBlock& registers, const Figures& figures,
                                       Nanoseconds window);

/// "hull since its map: 1.32 m deeper, sinking 1.1 m/h; ...": how it lies, and how fast that changes. Sides
/// and ends are those of the quay's axes, hulltrackd(8).
[[nodiscard]] std::string hull_line(const std::optional<HullFigures>& hull, SteadyTime now);

}  // namespace hulltrack
