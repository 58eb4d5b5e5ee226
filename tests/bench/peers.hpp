// The libraries that the benchmarks compare with, behind plain functions.
//
// nanoflann and PCL are dependencies of the benchmarks alone. Each peer gets its data in its own layout
// before the clock starts. Frames and units as in the project: metres, rad.
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "core/geometry/cloud.hpp"
#include "core/registration/point_to_point_icp.hpp"

namespace hulltrack::bench {

/// Debian's nanoflann: float, leaf of 10, every search bounded by the radius.
class NanoflannTree {
 public:
  /// `cloud` must outlive the tree.
  explicit NanoflannTree(const Cloud& cloud);
  ~NanoflannTree();
  void nearest(std::span<const Point> queries, float radius, std::span<Neighbour> out) const;

  /// The paper's algorithm as PointToPointIcp runs it, with a search for every point in every iteration.
  [[nodiscard]] IcpResult align(std::span<const Point> source, const Pose& T_init,
                                const IcpConfig& config) const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

/// PCL's KdTreeFLANN: its radius search, limited to one answer, which is the nearest.
class PclTree {
 public:
  explicit PclTree(const Cloud& cloud);
  ~PclTree();
  void nearest(std::span<const Point> queries, float radius, std::span<Neighbour> out) const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

/// PCL's IterativeClosestPoint (SVD) with its own tree over the map, as it comes.
class PclIcp {
 public:
  explicit PclIcp(const Cloud& map);
  ~PclIcp();
  [[nodiscard]] Pose align(const Cloud& source, const Pose& T_init, const IcpConfig& config) const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

/// PCL's VoxelGrid (centroids).
class PclVoxelGrid {
 public:
  explicit PclVoxelGrid(const Cloud& cloud);
  ~PclVoxelGrid();
  [[nodiscard]] std::size_t filter(float voxel_size) const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace hulltrack::bench
