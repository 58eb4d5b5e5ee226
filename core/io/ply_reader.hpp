// Vertices of a PLY file (Stanford triangle format 1.0) that is already in memory.
//
// ascii, binary_little_endian, binary_big_endian; `element vertex` first, with x, y, z of type float or
// double and no lists; other properties are passed over, elements behind (faces) are ignored.
// Points come as they stand in the file, finite or not. Counts are checked before memory is taken.
#pragma once

#include <string_view>

#include "core/base/result.hpp"
#include "core/geometry/cloud.hpp"

namespace hulltrack {

/// Does the file look like PLY? (Its header may still be wrong.)
[[nodiscard]] bool is_ply(std::string_view bytes);

/// The message has no file name; a line is named where there is one ("line 7: ...").
[[nodiscard]] Result<Cloud> parse_ply(std::string_view bytes);

}  // namespace hulltrack
