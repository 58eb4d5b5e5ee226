// What the process that reads the files hands to the service: their content, judged, as bytes.
//
// Both sides are the same program on the same computer, so numbers stand as they lie in memory. The reading
// side trusts nothing: every count and length is held against its bound and against the bytes that are there
// before memory is taken for it, and every point must be one that a map may have.
// Failure: a line that says what is wrong with the bytes. Pure but for write_prepared_files.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

#include "core/base/result.hpp"
#include "core/geometry/cloud.hpp"
#include "daemon/config/problem.hpp"

namespace hulltrack {

struct PreparedFiles {
  std::vector<Problem> problems = {};
  std::vector<std::string> calibrations =
      {};  // content of each LiDAR's file, in the order of the LiDARs; "" = none
  std::string map_remark = {};
  Cloud map_H = {};   // empty if and only if there are problems
  Cloud quay_W = {};  // empty with problems, and where no quay map is named
};

/// A calibration is some kilobytes; this is far more than any.
inline constexpr std::size_t kMaxCalibration = 16U << 20U;  // bytes

/// At the descriptor's place. Throws std::system_error when it cannot be written.
void write_prepared_files(int fd, const PreparedFiles& files);

[[nodiscard]] Result<PreparedFiles> parse_prepared_files(std::string_view bytes);

}  // namespace hulltrack
