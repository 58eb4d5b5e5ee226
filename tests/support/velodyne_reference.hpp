// The reference cloud of a real VLP-16 capture: what another decoder made of its packets.
//
// Lives outside the repository (HULLTRACK_SHARED_DIR); tests skip where it is absent.
#pragma once

#include <array>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <map>
#include <string>
#include <vector>

namespace hulltrack::test {

struct ReferencePoint {
  double x = 0, y = 0, z = 0;
  int intensity = 0;
  int packet = 0;
  int block = 0;
  int slot = 0;
  bool clean = false;  // free of the reference decoder's known defects
};

inline std::filesystem::path velodyne_reference_folder() {
  return std::filesystem::path(HULLTRACK_SHARED_DIR) / "lidar" / "velodyne_vlp16";
}

/// Rows of truth.csv.gz; empty when it cannot be read.
inline std::vector<ReferencePoint> read_velodyne_reference() {
  std::vector<ReferencePoint> points;
  const auto path = velodyne_reference_folder() / "truth.csv.gz";
  if (!std::filesystem::exists(path)) return points;
  const std::string command = "gzip -dc '" + path.string() + "'";
  std::FILE* pipe = popen(command.c_str(), "r");
  if (pipe == nullptr) return points;
  char line[512];
  while (std::fgets(line, sizeof line, pipe) != nullptr) {
    std::array<double, 13> value{};
    const char* at = line;
    bool numbers = true;
    for (double& v : value) {
      char* end = nullptr;
      v = std::strtod(at, &end);
      numbers = numbers && end != at;
      at = end + (*end == ',' ? 1 : 0);
    }
    if (!numbers) continue;  // the header
    points.push_back({value[0], value[1], value[2], static_cast<int>(value[3]), static_cast<int>(value[9]),
                      static_cast<int>(value[10]), static_cast<int>(value[11]), value[12] != 0.0});
  }
  pclose(pipe);
  return points;
}

}  // namespace hulltrack::test
