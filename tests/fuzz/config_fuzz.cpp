// Any bytes as configuration: never a crash, every problem has a line in the file and one line of text,
// and what is accepted prints to something that is accepted and prints the same.
#include <cstdint>
#include <cstdlib>
#include <string_view>
#include <vector>

#include "daemon/config/read_config.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace hulltrack;
  static const std::vector<LidarModel> kModels{{.name = "velodyne_vlp16", .port = 2368}};
  const std::string_view text(reinterpret_cast<const char*>(data), size);
  const ConfigReading reading = parse_config(text, "/a/b.toml", kModels);
  if (reading.config.has_value() != reading.problems.empty()) {
    std::abort();
  }
  for (const Problem& problem : reading.problems) {
    if (problem.line < 0 || problem.message.empty() || problem.message.find('\n') != std::string::npos) {
      std::abort();
    }
  }
  if (reading.config) {
    const std::string printed = print_config(*reading.config);
    const ConfigReading again = parse_config(printed, "/a/b.toml", kModels);
    if (!again.config || print_config(*again.config) != printed) {
      std::abort();
    }
  }
  return 0;
}
