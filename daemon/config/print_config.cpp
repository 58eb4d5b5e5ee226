#include "daemon/config/key_table.hpp"
#include "daemon/config/read_config.hpp"
#include "daemon/config/value_text.hpp"

namespace hulltrack {
namespace {

void print_section(const Section& section, const std::string& heading, std::string& out) {
  out += (out.empty() ? "" : "\n") + heading + '\n';
  for (const Key& key : section.keys) {
    out += key.name + " = " + toml_text(key.get()) + '\n';
  }
}

}  // namespace

std::string print_config(const Config& config) {
  Config copy = config;  // sections bind to something that they could change
  std::string out;
  for (const Section& section : config_sections(copy)) {
    print_section(section, '[' + section.name + ']', out);
  }
  for (LidarConfig& lidar : copy.lidars) {
    for (const Section& section : lidar_sections(lidar, {})) {
      const bool whole = section.name == kLidarSection;
      print_section(section, whole ? "[[" + section.name + "]]" : '[' + section.name + ']', out);
    }
  }
  return out;
}

}  // namespace hulltrack
