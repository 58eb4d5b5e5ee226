// A unit's angle correction file: where each of its lasers really points.
//
// Text as PandarView and the sensor itself give it out: a line `Channel,Elevation,Azimuth` (or `Laser
// id,...`), then one line a laser, angles in degrees; an `EEFF` line before it, a check sum after it, blank
// lines, lines from #, CR LF and a byte order mark are passed over. Each laser has to be there once and to
// point within 2 deg of where the model's design has it, which tells a file of another model. At most 64 KiB.
// Errors name file and line, what is wrong and what is allowed. Thread rule: pure functions.
#pragma once

#include <filesystem>
#include <string_view>
#include <vector>

#include "core/base/result.hpp"
#include "lidar_drivers/hesai/hesai_format.hpp"

namespace hulltrack::hesai {

/// One entry a laser of the model, as in the file, or as designed when the path is empty.
[[nodiscard]] Result<std::vector<LaserAngles>> load_angles(const std::filesystem::path& file,
                                                           const ModelTable& model);

/// The same of the file's content; `name` stands for the file in messages.
[[nodiscard]] Result<std::vector<LaserAngles>> parse_angles(std::string_view content, std::string_view name,
                                                            const ModelTable& model);

}  // namespace hulltrack::hesai
