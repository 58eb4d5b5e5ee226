#include <pcl/filters/voxel_grid.h>
#include <pcl/kdtree/kdtree_flann.h>
#include <pcl/registration/icp.h>

#include <cmath>

#include "tests/bench/peers.hpp"

namespace hulltrack::bench {
namespace {

using PclCloud = pcl::PointCloud<pcl::PointXYZ>;

PclCloud::Ptr to_pcl(std::span<const Point> cloud) {
  auto out = std::make_shared<PclCloud>();
  for (const Point& p : cloud) {
    out->push_back({p.x(), p.y(), p.z()});
  }
  return out;
}

}  // namespace

struct PclTree::Impl {
  pcl::KdTreeFLANN<pcl::PointXYZ> tree;
};

PclTree::PclTree(const Cloud& cloud) : impl_(std::make_unique<Impl>()) {
  impl_->tree.setInputCloud(to_pcl(cloud));
}
PclTree::~PclTree() = default;

void PclTree::nearest(std::span<const Point> queries, float radius, std::span<Neighbour> out) const {
  std::vector<int> indices(1);
  std::vector<float> squared_distances(1);
  for (std::size_t i = 0; i < queries.size(); ++i) {
    const pcl::PointXYZ query(queries[i].x(), queries[i].y(), queries[i].z());
    const bool found = impl_->tree.radiusSearch(query, radius, indices, squared_distances, 1) > 0;
    out[i] = {found ? static_cast<std::uint32_t>(indices[0]) : Neighbour::kNone,
              found ? squared_distances[0] : radius * radius};
  }
}

struct PclIcp::Impl {
  mutable pcl::IterativeClosestPoint<pcl::PointXYZ, pcl::PointXYZ> icp;
};

PclIcp::PclIcp(const Cloud& map) : impl_(std::make_unique<Impl>()) {
  const auto target = to_pcl(map);
  impl_->icp.setInputTarget(target);
  // Its tree is built here, as ours is, and not again within each alignment.
  const auto tree = impl_->icp.getSearchMethodTarget();
  tree->setInputCloud(target);
  impl_->icp.setSearchMethodTarget(tree, true);
}
PclIcp::~PclIcp() = default;

Pose PclIcp::align(const Cloud& source, const Pose& T_init, const IcpConfig& config) const {
  auto& icp = impl_->icp;
  icp.setInputSource(to_pcl(source));
  icp.setMaxCorrespondenceDistance(config.max_correspondence_distance);
  icp.setMaximumIterations(config.max_iterations);
  // PCL compares the squared translation and the rotation's cosine.
  icp.setTransformationEpsilon(config.translation_epsilon * config.translation_epsilon);
  icp.setTransformationRotationEpsilon(std::cos(config.rotation_epsilon));
  PclCloud aligned;
  icp.align(aligned, T_init.matrix().cast<float>());
  return Pose(icp.getFinalTransformation().cast<double>());
}

struct PclVoxelGrid::Impl {
  PclCloud::Ptr cloud;
};

PclVoxelGrid::PclVoxelGrid(const Cloud& cloud) : impl_(std::make_unique<Impl>(Impl{to_pcl(cloud)})) {}
PclVoxelGrid::~PclVoxelGrid() = default;

std::size_t PclVoxelGrid::filter(float voxel_size) const {
  pcl::VoxelGrid<pcl::PointXYZ> grid;
  grid.setInputCloud(impl_->cloud);
  grid.setLeafSize(voxel_size, voxel_size, voxel_size);
  PclCloud out;
  grid.filter(out);
  return out.size();
}

}  // namespace hulltrack::bench
