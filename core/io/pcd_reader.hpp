// Points of a PCD file (Point Cloud Library's format 0.6, 0.7) that is already in memory.
//
// DATA ascii, binary or binary_compressed; x, y, z of type F and size 4 or 8, other fields are passed
// over. Points come as the file's own VIEWPOINT puts them, finite or not.
// Every count in the header is checked against the bytes that are there before memory is taken.
#pragma once

#include <string_view>

#include "core/base/result.hpp"
#include "core/geometry/cloud.hpp"
#include "core/geometry/se3.hpp"

namespace hulltrack {

/// Does the file look like PCD? (Its header may still be wrong.)
[[nodiscard]] bool is_pcd(std::string_view bytes);

struct PcdCloud {
  Cloud points;
  Pose viewpoint;  // that moved them, as VIEWPOINT says: x y z, then w x y z of the quaternion
};

/// The message has no file name; a line is named where there is one ("line 7: ...").
[[nodiscard]] Result<PcdCloud> parse_pcd(std::string_view bytes);

}  // namespace hulltrack
