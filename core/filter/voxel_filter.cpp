#include "core/filter/voxel_filter.hpp"

#include <algorithm>
#include <array>
#include <cassert>
#include <limits>

namespace hulltrack {
namespace {

constexpr std::uint32_t kNoVoxel = std::numeric_limits<std::uint32_t>::max();
constexpr std::uint64_t kEmptyKey = std::numeric_limits<std::uint64_t>::max();
constexpr std::size_t kFirstTableSize = 1024;

// So many points at a time have their places in the table fetched into the cache before they are looked up.
constexpr std::size_t kBlock = 64;

constexpr float kReach = 1048576.0F;  // voxels from the origin along each axis: 21 bits with the sign
constexpr int kAxisBits = 21;

// Whole part of a coordinate in voxels, rounded down and counted from the far corner of the reach.
std::uint64_t cell_of(float coordinate) {
  const auto towards_zero = static_cast<std::int32_t>(coordinate);
  const std::int32_t down = towards_zero - (static_cast<float>(towards_zero) > coordinate ? 1 : 0);
  return static_cast<std::uint64_t>(down + static_cast<std::int32_t>(kReach));
}

// The voxel's three coordinates side by side in 63 bits; kEmptyKey for a point that has no voxel.
std::uint64_t key_of(const Point& p, float inverse_size) {
  const float x = p.x() * inverse_size;
  const float y = p.y() * inverse_size;
  const float z = p.z() * inverse_size;
  // Written such that a NaN fails.
  const bool inside = x >= -kReach && x < kReach && y >= -kReach && y < kReach && z >= -kReach && z < kReach;
  if (!inside) {
    return kEmptyKey;
  }
  return (cell_of(x) << (2 * kAxisBits)) | (cell_of(y) << kAxisBits) | cell_of(z);
}

std::size_t hash(std::uint64_t key) {
  key *=
      0x9E3779B97F4A7C15U;  // 2^64 / golden ratio: spreads neighbouring keys (Knuth, multiplicative hashing)
  return static_cast<std::size_t>(key >> 32);
}

}  // namespace

VoxelFilter::VoxelFilter(double voxel_size)
    : inverse_size_(static_cast<float>(1.0 / voxel_size)),
      table_(kFirstTableSize, Slot{kEmptyKey, kNoVoxel}) {
  assert(voxel_size > 0.0);
}

std::uint32_t VoxelFilter::voxel_of(std::uint64_t key) {
  const std::size_t mask = table_.size() - 1;
  std::size_t at = hash(key) & mask;
  while (table_[at].key != key) {
    if (table_[at].key == kEmptyKey) {
      table_[at] = {key, static_cast<std::uint32_t>(voxels_.size())};
      voxels_.push_back({Eigen::Vector3d::Zero(), 0.0});
      keys_.push_back(key);
      if (2 * voxels_.size() > table_.size()) {
        grow();
      }
      return static_cast<std::uint32_t>(voxels_.size() - 1);
    }
    at = (at + 1) & mask;
  }
  return table_[at].voxel;
}

void VoxelFilter::grow() {
  const std::size_t mask = 2 * table_.size() - 1;
  table_.assign(2 * table_.size(), Slot{kEmptyKey, kNoVoxel});
  for (std::uint32_t voxel = 0; voxel < keys_.size(); ++voxel) {
    std::size_t at = hash(keys_[voxel]) & mask;
    while (table_[at].key != kEmptyKey) {
      at = (at + 1) & mask;
    }
    table_[at] = {keys_[voxel], voxel};
  }
}

std::span<const std::uint32_t> VoxelFilter::select(std::span<const Point> cloud) {
  std::fill(table_.begin(), table_.end(), Slot{kEmptyKey, kNoVoxel});
  voxels_.clear();
  keys_.clear();
  voxel_of_point_.resize(cloud.size());

  std::array<std::uint64_t, kBlock> keys;
  for (std::size_t first = 0; first < cloud.size(); first += kBlock) {
    const std::span<const Point> block = cloud.subspan(first, std::min(kBlock, cloud.size() - first));
    for (std::size_t i = 0; i < block.size(); ++i) {
      keys[i] = key_of(block[i], inverse_size_);
      __builtin_prefetch(&table_[hash(keys[i]) & (table_.size() - 1)]);
    }
    for (std::size_t i = 0; i < block.size(); ++i) {
      const std::uint32_t at = keys[i] == kEmptyKey ? kNoVoxel : voxel_of(keys[i]);
      voxel_of_point_[first + i] = at;
      if (at != kNoVoxel) {
        Voxel& voxel = voxels_[at];
        voxel.centroid += block[i].cast<double>();  // the sum until all points are in
        voxel.count += 1.0;
      }
    }
  }

  for (Voxel& voxel : voxels_) {
    voxel.centroid /= voxel.count;
  }
  best_.assign(voxels_.size(), std::numeric_limits<double>::infinity());
  representatives_.resize(voxels_.size());
  for (std::size_t i = 0; i < cloud.size(); ++i) {
    const std::uint32_t voxel = voxel_of_point_[i];
    if (voxel == kNoVoxel) {
      continue;
    }
    const double squared = (cloud[i].cast<double>() - voxels_[voxel].centroid).squaredNorm();
    if (squared < best_[voxel]) {
      best_[voxel] = squared;
      representatives_[voxel] = static_cast<std::uint32_t>(i);
    }
  }
  return representatives_;
}

void VoxelFilter::filter(std::span<const Point> cloud, Cloud& out) {
  const std::span<const std::uint32_t> indices = select(cloud);
  out.clear();
  for (const std::uint32_t i : indices) {
    out.push_back(cloud[i]);
  }
}

}  // namespace hulltrack
