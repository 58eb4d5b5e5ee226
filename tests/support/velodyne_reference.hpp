// The reference cloud of a real VLP-16 capture: what another decoder made of its packets.
#pragma once

#include <map>
#include <vector>

#include "tests/support/reference_csv.hpp"

namespace hulltrack::test {

struct ReferencePoint {
  double x = 0, y = 0, z = 0;
  int intensity = 0;
  int packet = 0;
  int block = 0;
  int slot = 0;
  bool clean = false;  // free of the reference decoder's known defects
};

inline std::filesystem::path velodyne_reference_folder() { return reference_folder("velodyne_vlp16"); }

/// Rows of truth.csv.gz; empty when it cannot be read.
inline std::vector<ReferencePoint> read_velodyne_reference() {
  std::vector<ReferencePoint> points;
  for (const auto& row : read_csv_gz<13>(velodyne_reference_folder() / "truth.csv.gz")) {
    points.push_back({row[0], row[1], row[2], static_cast<int>(row[3]), static_cast<int>(row[9]),
                      static_cast<int>(row[10]), static_cast<int>(row[11]), row[12] != 0.0});
  }
  return points;
}

}  // namespace hulltrack::test
