// The map that a ship is tracked by: read, cleared of stray points, judged, built.
//
// The same for the service's start, a reload, --check-config and `hulltrack replay`. Frame H, metres.
// Failure: findings that refuse. Never throws on what the file holds, but std::bad_alloc. Pure but for the
// file. Cost: as long as the map takes to read and build, in proportion to its points.
#pragma once

#include <filesystem>
#include <functional>
#include <memory>
#include <vector>

#include "core/map/hull_map.hpp"
#include "core/tracking/map_judge.hpp"

namespace hulltrack {

struct LoadedMap {
  std::shared_ptr<const HullMap> map;  // nullptr: a finding refuses it
  std::vector<MapFinding> findings;    // messages about the map begin with its file
};

/// `building`, where given, is called when the file has been read and what the tracker needs of it is made.
[[nodiscard]] LoadedMap load_map(const std::filesystem::path& file, const TrackerConfig& config,
                                 const std::function<void()>& building = {});

}  // namespace hulltrack
