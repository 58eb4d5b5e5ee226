// The reference map of one ship: immutable cloud, search tree, and what the metrics need of it.
//
// Frame H, metres. Built once at start-up; shared between threads afterwards.
// Precondition of the constructor: a non-empty cloud of finite points (core/io checks files).
#pragma once

#include "core/geometry/cloud.hpp"
#include "core/search/kdtree.hpp"

namespace hulltrack {

class HullMap {
 public:
  explicit HullMap(Cloud cloud_H) : cloud_H_(std::move(cloud_H)), tree_(cloud_H_) {}

  [[nodiscard]] const Cloud& cloud_H() const { return cloud_H_; }
  [[nodiscard]] const KdTree& tree() const { return tree_; }

 private:
  Cloud cloud_H_;
  KdTree tree_;
};

}  // namespace hulltrack
