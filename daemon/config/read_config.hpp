// Reads the configuration: TOML text -> Config, or every problem there is with it.
//
// Nothing starts on a configuration with a problem. Cost: milliseconds, allocates. Pure but for the
// file that read_config opens; never throws on any input.
#pragma once

#include <filesystem>
#include <map>
#include <optional>
#include <set>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "core/base/result.hpp"
#include "daemon/config/config.hpp"
#include "daemon/config/problem.hpp"
#include "lidar_drivers/lidar_model.hpp"

namespace hulltrack {

struct ConfigReading {
  std::optional<Config> config;      // present if and only if problems is empty
  std::vector<Problem> problems;     // in order of their lines
  std::map<std::string, int> lines;  // of every key and section that the file has: "hull.map", "lidar.0"
  Config readable;                   // what could be read, so that files it names can be checked all the same
  std::set<std::string> bad_keys;    // whose values are not legal: in `readable` they have their defaults
  /// Whom to tell that nothing starts: [plc], if neither it nor anything that may have been meant for it has
  /// a problem.
  std::optional<PlcConfig> plc;

  /// A problem that shows only later, such as a map that cannot be read: said of `key` ("hull.map",
  /// "lidar.0.calibration"), at its line or else that of its section.
  [[nodiscard]] Problem problem_with(const std::filesystem::path& file, const std::string& key,
                                     const std::string& message) const;
};

/// `models`: every LiDAR model of this build; a `model` outside it is a problem, and the ports' defaults are
/// its own.
[[nodiscard]] ConfigReading read_config(const std::filesystem::path& file,
                                        std::span<const LidarModel> models);

/// The text alone, unread by any parser; of a file of more than 1 MiB the beginning, which parse_config
/// refuses. An error says why the file cannot be read, without its name.
[[nodiscard]] Result<std::string> read_config_text(const std::filesystem::path& file);

/// As read_config for text already in memory; `file` names it in messages, and relative paths in the
/// text are relative to its folder.
[[nodiscard]] ConfigReading parse_config(std::string_view text, const std::filesystem::path& file,
                                         std::span<const LidarModel> models);

/// The effective values of every key as TOML that reads back equal.
[[nodiscard]] std::string print_config(const Config& config);

}  // namespace hulltrack
