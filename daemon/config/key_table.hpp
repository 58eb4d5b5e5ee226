// The one table of the configuration's keys: name, place, what is allowed, and the value it sets.
//
// Reading, validation, printing, the search for the nearest name and the check of the documents all walk
// this table; a key is added by one line in key_table.cpp. A Section is bound to the Config it was made
// from and must not outlive it. Values stand in the file's units (ms, deg), the Config's are SI.
#pragma once

#include <cstdint>
#include <functional>
#include <span>
#include <string>
#include <variant>
#include <vector>

#include "daemon/config/config.hpp"
#include "lidar_drivers/lidar_model.hpp"

namespace hulltrack {

/// A value as TOML knows it. Numbers that may have a fraction are double, whole ones int64.
using Numbers = std::vector<double>;
using ConfigValue = std::variant<bool, std::int64_t, double, std::string, Numbers, std::vector<Numbers>>;

struct Key {
  std::string name;
  std::string allowed;                            // "a whole number from 1 to 65535"
  std::function<bool(const ConfigValue&)> legal;  // given a value of the same alternative as get()'s
  std::function<ConfigValue()> get;               // the effective value; on a fresh Config the default
  std::function<void(const ConfigValue&)> set;    // precondition: legal
  bool required = false;
  std::vector<std::string> words = {};  // the legal texts, where they can be listed
  /// Values of other alternatives that it takes as well: a number beside a word, say.
  std::vector<ConfigValue> others = {};
};

/// A TOML table: "plc.read", or "plc.read.travel" for an inline one.
struct Section {
  std::string name;
  std::vector<Key> keys;
};

inline constexpr const char* kLidarSection = "lidar";  // an array of tables
inline constexpr const char* kLidarMountSection = "lidar.mount";

/// Every section except the LiDARs', in the order of the sample file.
[[nodiscard]] std::vector<Section> config_sections(Config& config);

/// The sections of one [[lidar]] entry. `models`: those allowed; empty = any.
[[nodiscard]] std::vector<Section> lidar_sections(LidarConfig& lidar, std::span<const LidarModel> models);

}  // namespace hulltrack
