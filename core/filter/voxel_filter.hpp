// Thins a cloud to one real point a voxel (Guo 2025, 2.3 a).
//
// It keeps the point nearest to the centroid of its voxel's points, ties by index. Why not another:
//   - the point nearest to the voxel's middle leans towards the grid: a deck lies at one height, so every
//     voxel on it would lean the same way;
//   - the first point has all of a return's noise, while the one nearest to the centroid lies in the middle
//     of it;
//   - the centroid itself was not measured.
// Voxels are cubes with corners at whole multiples of the size from the frame's origin. Any frame; m.
// Failure: none; points that are not finite or lie more than 2^20 voxels from the origin are left out.
// Thread rule: one owner; scratch memory is kept between calls. Cost: linear in the points.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "core/geometry/cloud.hpp"

namespace hulltrack {

class VoxelFilter {
 public:
  /// `voxel_size` > 0, m.
  explicit VoxelFilter(double voxel_size);

  /// Indices of the representatives, in the order in which the cloud first enters their voxels.
  /// The span lives until the next call.
  [[nodiscard]] std::span<const std::uint32_t> select(std::span<const Point> cloud);

  /// The representatives themselves, in the same order. `out` is replaced; it must not be `cloud`.
  void filter(std::span<const Point> cloud, Cloud& out);

 private:
  struct Voxel {
    Eigen::Vector3d centroid;
    double count;
  };
  struct Slot {
    std::uint64_t key;
    std::uint32_t voxel;
  };

  [[nodiscard]] std::uint32_t voxel_of(std::uint64_t key);
  void grow();

  float inverse_size_;
  std::vector<Slot> table_;  // open addressing, a power of two, at most half full
  std::vector<Voxel> voxels_;
  std::vector<std::uint64_t> keys_;  // per voxel
  std::vector<std::uint32_t> voxel_of_point_;
  std::vector<double> best_;  // per voxel: least squared distance to the centroid, m^2
  std::vector<std::uint32_t> representatives_;
};

}  // namespace hulltrack
