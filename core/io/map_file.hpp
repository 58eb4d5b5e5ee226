// Reads the map of a hull from a PCD (ascii, binary, binary_compressed) or PLY (ascii, binary) file.
//
// Frame H, metres, coordinates within 10 km of the origin (float keeps 1 mm there). The kind of file is
// told by its content, not its name. Every size in a header is checked against the file before memory is
// taken for it. Failure: one line that names the file, what is wrong and what to do. Start-up only.
#pragma once

#include <cstddef>
#include <filesystem>
#include <string>
#include <vector>

#include "core/base/result.hpp"
#include "core/geometry/cloud.hpp"
#include "core/geometry/se3.hpp"

namespace hulltrack {

/// A larger map costs memory and time and gains nothing: 5 cm voxels of a 300 m ship stay below it.
inline constexpr std::size_t kMaxMapPoints = 20'000'000;
/// Farther from the origin than this float loses millimetres.
inline constexpr float kMaxMapCoordinate = 10'000.0F;

struct MapFile {
  Cloud cloud;                       // finite points only, in the file's order; never empty
  std::size_t dropped = 0;           // points left out: not finite, or too far from the origin
  Pose moved_by = Pose::Identity();  // the file's own transform (VIEWPOINT), which the points went through
};

/// Some dropped points are normal (organised clouds mark missing returns with NaN); a file in which they
/// outnumber the good ones is refused.
[[nodiscard]] Result<MapFile> read_map_file(const std::filesystem::path& file);

/// Lines for whoever starts to work with `map`: what was done to its points, and what to do if that is wrong.
/// Empty when they are what stands in the file.
[[nodiscard]] std::vector<std::string> remarks_on(const std::filesystem::path& file, const MapFile& map);

}  // namespace hulltrack
