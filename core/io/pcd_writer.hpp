// Writes a cloud as a binary PCD file (version 0.7), the format of maps and of decoded scans.
//
// Frame and units are the cloud's; points are stored as they are. Cost: one pass, 12 or 16 bytes a point.
#pragma once

#include <filesystem>
#include <span>

#include "core/base/result.hpp"
#include "core/geometry/cloud.hpp"

namespace hulltrack {

/// Creates or replaces `file`. `intensity` is empty or holds one value for each point.
/// On an error (a full disk, say) the file is incomplete; the message names it.
[[nodiscard]] Result<void> write_pcd(const std::filesystem::path& file, std::span<const Point> cloud,
                                     std::span<const float> intensity = {});

}  // namespace hulltrack
