// Fills a Config from a parsed TOML document by walking the key table, and notes what is wrong.
//
// Every key, known or not, is looked at once; a value that is not legal leaves the default in place and
// its key in bad_keys, so that rules between keys can leave it alone. toml++ is seen in .cpp files only.
#pragma once

#include <map>
#include <set>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "daemon/config/config.hpp"
#include "daemon/config/problem.hpp"
#include "lidar_drivers/lidar_model.hpp"

namespace hulltrack {

struct Document {
  Config config;
  std::vector<Problem> problems;     // `file` as given to read_document
  std::map<std::string, int> lines;  // of every key and table present: "plc.read.slew.offset", "lidar.0"
  std::set<std::string> bad_keys;
  std::set<std::string> blamed;  // first names of keys that a problem touches: "plc", "lidar", "plcc"
};

[[nodiscard]] Document read_document(std::string_view text, const std::string& file,
                                     std::span<const LidarModel> models);

}  // namespace hulltrack
