// Everything that the service needs from files, read and checked before any of it is used.
//
// The same function serves the start, a reload (in a thread of its own, while the old configuration is
// still in force) and --check-config. Cost: as long as the map takes to read. Never throws on what the
// files hold; thread rule: pure but for the files that it reads.
#pragma once

#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "core/map/hull_map.hpp"
#include "core/map/quay_map.hpp"
#include "daemon/config/config.hpp"
#include "daemon/config/problem.hpp"

namespace hulltrack {

/// What a configuration file comes to, ready to run.
struct Prepared {
  Config config;
  std::shared_ptr<const HullMap> map;
  std::shared_ptr<const QuayMap> quay;  // nullptr = none is configured
  std::string map_remark;  // what to know of a map that can be used all the same; empty = nothing
};

struct Preparation {
  std::optional<Prepared> prepared;  // present if and only if problems is empty
  std::vector<Problem> problems;     // of the configuration, the calibrations and the map
};

[[nodiscard]] Preparation prepare(const std::filesystem::path& config_file);

}  // namespace hulltrack
