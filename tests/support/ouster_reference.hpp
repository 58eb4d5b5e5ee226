// The reference cloud of a real OS-1-128 capture: what the maker's own library made of its middle frame.
//
// Lives outside the repository (HULLTRACK_SHARED_DIR); tests skip where it is absent.
#pragma once

#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <string>
#include <vector>

namespace hulltrack::test {

struct OusterReferencePoint {
  double x = 0, y = 0, z = 0;
  int range_mm = 0;
  int row = 0;
  int measurement_id = 0;
  std::int64_t timestamp_ns = 0;
  int reflectivity = 0;
};

inline std::filesystem::path ouster_reference_folder() {
  return std::filesystem::path(HULLTRACK_SHARED_DIR) / "lidar" / "ouster_os1-128";
}

/// Rows of truth.csv.gz, by measurement id, then row; empty when it cannot be read.
inline std::vector<OusterReferencePoint> read_ouster_reference() {
  std::vector<OusterReferencePoint> points;
  const auto path = ouster_reference_folder() / "truth.csv.gz";
  if (!std::filesystem::exists(path)) return points;
  const std::string command = "gzip -dc '" + path.string() + "'";
  std::FILE* pipe = popen(command.c_str(), "r");
  if (pipe == nullptr) return points;
  char line[512];
  while (std::fgets(line, sizeof line, pipe) != nullptr) {
    OusterReferencePoint p;
    long long stamp = 0;
    const int read = std::sscanf(line, "%lf,%lf,%lf,%d,%d,%d,%lld,%d", &p.x, &p.y, &p.z, &p.range_mm, &p.row,
                                 &p.measurement_id, &stamp, &p.reflectivity);
    if (read != 8) continue;  // the header
    p.timestamp_ns = stamp;
    points.push_back(p);
  }
  pclose(pipe);
  return points;
}

}  // namespace hulltrack::test
