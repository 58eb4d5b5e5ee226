// The sample file and the man page against the table of keys: neither may miss or misquote one.
#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <set>
#include <sstream>
#include <string>
#include <vector>

#include "daemon/config/key_table.hpp"
#include "daemon/config/read_config.hpp"
#include "daemon/config/value_text.hpp"
#include "tests/support/temp_folder.hpp"

namespace hulltrack {
namespace {

const std::string kSample = HULLTRACK_SOURCE_DIR "/etc/hulltrackd.toml";
const std::vector<LidarModel> kModels{{.name = "velodyne_vlp16", .port = 2368}};
const std::string kManPage = HULLTRACK_SOURCE_DIR "/daemon/man/hulltrackd.toml.5";

struct DocumentedKey {
  std::string section, name, value;  // the default as TOML
  bool required;
};

std::vector<DocumentedKey> all_keys() {
  Config config;
  LidarConfig lidar;
  auto sections = config_sections(config);
  for (const Section& section : lidar_sections(lidar, {})) {
    sections.push_back(section);
  }
  std::vector<DocumentedKey> keys;
  for (const Section& section : sections) {
    for (const Key& key : section.keys) {
      keys.push_back({section.name, key.name, toml_text(key.get()), key.required});
    }
  }
  return keys;
}

std::string replaced(std::string text, const std::string& from, const std::string& to) {
  for (auto at = text.find(from); at != std::string::npos; at = text.find(from, at + to.size())) {
    text.replace(at, from.size(), to);
  }
  return text;
}

TEST(SampleFile, ReadsWithoutAProblemAndHoldsTheDefaults) {
  const auto reading = read_config(kSample, kModels);
  ASSERT_TRUE(reading.config) << to_string(reading.problems.at(0));
  Config defaults;
  defaults.plc.host = reading.config->plc.host;
  defaults.map_file = reading.config->map_file;
  defaults.lidars.resize(1);
  defaults.lidars[0].model = reading.config->lidars.at(0).model;
  EXPECT_EQ(print_config(*reading.config), print_config(defaults));
}

TEST(SampleFile, HasEveryKey) {
  const auto reading = read_config(kSample, kModels);
  for (const DocumentedKey& key : all_keys()) {
    const std::string lidar = kLidarSection;
    const std::string section =
        key.section.starts_with(lidar) ? lidar + ".0" + key.section.substr(lidar.size()) : key.section;
    const std::string place = section + '.' + key.name;
    EXPECT_TRUE(reading.lines.contains(place)) << place << " is missing in " << kSample;
  }
}

/// "plc.read.slew.offset" -> "2", as the man page gives it. One heading may stand for several sections,
/// one line for as many defaults.
std::map<std::string, std::string> man_page_defaults() {
  std::map<std::string, std::string> defaults;
  std::vector<std::string> sections;
  std::istringstream page(test::read_text(kManPage));
  for (std::string line; std::getline(page, line);) {
    line = replaced(replaced(line, "\\(dq", "\""), "\\-", "-");
    if (line.starts_with(".Ss ")) {
      sections.clear();
      std::istringstream names(line.substr(4));
      for (std::string name; names >> name;) {
        if (name != ",") sections.push_back(name);
      }
    } else if (line.starts_with(".It Li ")) {
      const auto equals = line.find(" = ");
      const std::string name = line.substr(7, equals - 7);
      const std::string text = line.substr(equals + 3);
      std::vector<std::string> values;
      std::istringstream parts(text);
      for (std::string part; std::getline(parts >> std::ws, part, ',');) values.push_back(part);
      for (std::size_t i = 0; i < sections.size(); ++i) {
        const bool one_each = sections.size() > 1 && values.size() == sections.size() && text.front() != '[';
        defaults[sections[i] + '.' + name] = one_each ? values[i] : text;
      }
    }
  }
  return defaults;
}

TEST(ManPage, HasEveryKeyWithItsDefaultAndNoOther) {
  auto documented = man_page_defaults();
  for (const DocumentedKey& key : all_keys()) {
    const std::string place = key.section + '.' + key.name;
    const auto found = documented.find(place);
    ASSERT_NE(found, documented.end()) << place << " is missing in " << kManPage;
    if (!key.required) {
      EXPECT_EQ(found->second, key.value) << place;
    }
    documented.erase(found);
  }
  EXPECT_TRUE(documented.empty()) << documented.begin()->first << " is no key";
}

}  // namespace
}  // namespace hulltrack
