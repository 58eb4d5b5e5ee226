// Points of a PCD file (Point Cloud Library's format 0.6, 0.7) that is already in memory.
//
// DATA ascii, binary or binary_compressed; x, y, z of type F and size 4 or 8, other fields are passed
// over, VIEWPOINT is ignored. Points come as they stand in the file, finite or not.
// Every count in the header is checked against the bytes that are there before memory is taken.
#pragma once

#include <string_view>

#include "core/base/result.hpp"
#include "core/geometry/cloud.hpp"

namespace hulltrack {

/// Does the file look like PCD? (Its header may still be wrong.)
[[nodiscard]] bool is_pcd(std::string_view bytes);

/// The message has no file name; a line is named where there is one ("line 7: ...").
[[nodiscard]] Result<Cloud> parse_pcd(std::string_view bytes);

}  // namespace hulltrack
