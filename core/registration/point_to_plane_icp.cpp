#include "core/registration/point_to_plane_icp.hpp"

#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>
#include <limits>

namespace hulltrack {
namespace {

// Kernels of the first four rounds of align(), m; later rounds keep the last one. The last one is 1.5 times
// the 1 sigma of a return's range. A narrower one would waste good pairs, a wider one would let in what lies
// a few centimetres off the map.
constexpr std::array<double, 4> kKernels = {0.20, 0.10, 0.05, 0.03};

// Stages of approach(). The first ones may shift the hull but not turn it: with a wide gate many pairs are
// with wrong planes.
struct Stage {
  float gate;  // m
  int rounds;
  bool turns;
};
constexpr std::array<Stage, 4> kApproach = {
    {{1.2F, 2, false}, {0.8F, 2, false}, {0.8F, 2, true}, {0.4F, 2, true}}};

constexpr int kInnerSteps = 2;

void report(const PlaneSystem& system, const PlaneSystem::Solution& solution, IcpResult& result) {
  result.matched = system.pairs();
  result.rms_residual = system.rms();
  result.normal_matrix = system.normal_matrix();
  result.centre = system.centre();
  result.free_directions = solution.free;
  result.last_rotation = solution.twist.head<3>().norm();
  result.last_translation = solution.twist.tail<3>().norm();
}

double kernel_of_round(int round) {
  return kKernels[std::min(static_cast<std::size_t>(round), kKernels.size() - 1)];
}

/// Distance of p from the plane, and whether p is farther than `besides` from its centre across the normal.
struct OnPlane {
  double residual;  // m, signed
  bool beside;
};
OnPlane on_plane(const Eigen::Vector3d& p, const PlaneMap::Plane& plane, double besides) {
  const Eigen::Vector3d d = p - plane.centre_H.cast<double>();
  const double r = plane.normal_H.cast<double>().dot(d);
  return {r, d.squaredNorm() - r * r > besides * besides};
}

}  // namespace

PointToPlaneIcp::PointToPlaneIcp(const PlaneIcpConfig& config, const BendShape& shape)
    : config_(config), shape_(shape), correspondences_(kGate) {
  assert(config.max_iterations >= 1 && shape.length > 0.0);
}

/// Calls visit(point, plane, residual against the bent plane, rise) for all pairs but those beside their
/// planes. The points are moved by at.T, the motion since the search.
template <typename Visit>
void PointToPlaneIcp::for_each_pair(std::span<const Correspondence> pairs, const PlaneMap& map,
                                    const Estimate& at, Visit&& visit) const {
  for (const Correspondence& pair : pairs) {
    const PlaneMap::Plane& plane = map.planes()[pair.index];
    const Eigen::Vector3d p = at.T * pair.source;
    const OnPlane on = on_plane(p, plane, kBesides);
    if (!on.beside) {
      const double rise = shape_.rise(p.x());
      visit(p, plane, on.residual - at.bend * rise * static_cast<double>(plane.normal_H.z()), rise);
    }
  }
}

PlaneSystem PointToPlaneIcp::system_of(std::span<const Correspondence> pairs, const PlaneMap& map,
                                       const Estimate& at, double kernel) const {
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  for (const Correspondence& pair : pairs) {
    sum += pair.source;
  }
  PlaneSystem system(at.T * Eigen::Vector3d(sum / std::max(1.0, static_cast<double>(pairs.size()))), kernel);
  for_each_pair(pairs, map, at,
                [&](const Eigen::Vector3d& p, const PlaneMap::Plane& plane, double r, double rise) {
                  system.add(p, plane.normal_H.cast<double>(), r, rise);
                });
  return system;
}

PlaneCovariance PointToPlaneIcp::covariance_of(std::span<const Correspondence> pairs, const PlaneMap& map,
                                               const Estimate& at) {
  const PlaneSystem system = system_of(pairs, map, at, kKernels.back());
  estimator_.reset(map.clusters());
  for_each_pair(pairs, map, at,
                [&](const Eigen::Vector3d& p, const PlaneMap::Plane& plane, double r, double rise) {
                  estimator_.add(system, plane.cluster, p, plane.normal_H.cast<double>(), r, rise);
                });
  return estimator_.estimate();
}

PlaneIcpResult PointToPlaneIcp::align(std::span<const Point> source, const PlaneMap& map, const Pose& T_init,
                                      const Bend& bend) {
  PlaneIcpResult out;
  IcpResult& result = out.icp;
  if (!T_init.matrix().allFinite()) {
    return out;
  }
  result.T_target_source = T_init;
  result.stop = IcpStop::iteration_limit;
  out.bend = bend.d;
  const double bend_information =
      bend.sigma > 0.0 ? PlaneSystem::kPairSigma * PlaneSystem::kPairSigma / (bend.sigma * bend.sigma)
                       : std::numeric_limits<double>::infinity();
  correspondences_.reset(source, map.tree());
  std::span<const Correspondence> pairs;
  Estimate at;
  for (int round = 0; round < config_.max_iterations && !result.converged; ++round) {
    pairs = correspondences_.find(result.T_target_source);
    ++result.iterations;
    at = {Pose::Identity(), out.bend};
    for (int step = 0; step < kInnerSteps; ++step) {
      const PlaneSystem system = system_of(pairs, map, at, kernel_of_round(round));
      const PlaneSystem::Solution solution = system.solve(at.bend - bend.d, bend_information);
      report(system, solution, result);
      if (solution.free == 6) {
        result.stop = IcpStop::too_few_matches;
        return out;
      }
      at.T = pose_from_twist_about(system.centre(), solution.twist) * at.T;
      at.bend += solution.bend;
    }
    result.T_target_source = at.T * result.T_target_source;
    out.bend = at.bend;
    result.converged = static_cast<std::size_t>(round) + 1 >= kKernels.size() &&
                       result.last_translation < config_.translation_epsilon &&
                       result.last_rotation < config_.rotation_epsilon;
  }
  if (result.converged) {
    result.stop = IcpStop::converged;
  }
  out.covariance = covariance_of(pairs, map, at);
  return out;
}

void PointToPlaneIcp::move(std::span<const Point> source, const Pose& T) {
  const Eigen::Matrix3f R = T.linear().cast<float>();
  const Point t = T.translation().cast<float>();
  moved_.clear();
  for (const Point& p : source) {
    moved_.push_back(R * p + t);
  }
  nearest_.resize(moved_.size());
}

Pose PointToPlaneIcp::approach(std::span<const Point> source, const PlaneMap& map, const Pose& T_init) {
  Pose T = T_init;
  for (const Stage& stage : kApproach) {
    for (int round = 0; round < stage.rounds; ++round) {
      move(source, T);
      map.tree().nearest(moved_, stage.gate, nearest_);
      Eigen::Vector3d sum = Eigen::Vector3d::Zero();
      for (const Point& p : moved_) {
        sum += p.cast<double>();
      }
      PlaneSystem system(sum / std::max<double>(1.0, static_cast<double>(moved_.size())),
                         static_cast<double>(stage.gate) / 2.0);
      for (std::size_t i = 0; i < moved_.size(); ++i) {
        if (nearest_[i].index != Neighbour::kNone) {
          const PlaneMap::Plane& plane = map.planes()[nearest_[i].index];
          const Eigen::Vector3d p = moved_[i].cast<double>();
          system.add(p, plane.normal_H.cast<double>(), on_plane(p, plane, kBesides).residual);
        }
      }
      const PlaneSystem::Solution solution = stage.turns ? system.solve() : system.solve_shift();
      T = pose_from_twist_about(system.centre(), solution.twist) * T;
      if (!T.matrix().allFinite()) {
        return T_init;
      }
    }
  }
  return T;
}

PlaneScore PointToPlaneIcp::score(std::span<const Point> source, const PlaneMap& map, const Pose& T) {
  move(source, T);
  map.tree().nearest(moved_, static_cast<float>(kGate), nearest_);
  PlaneScore score;
  score.points = static_cast<std::uint32_t>(source.size());
  for (std::size_t i = 0; i < moved_.size(); ++i) {
    if (nearest_[i].index == Neighbour::kNone) {
      continue;
    }
    const OnPlane at = on_plane(moved_[i].cast<double>(), map.planes()[nearest_[i].index], kBesides);
    if (!at.beside) {
      score.sum += kScoreKernel * kScoreKernel / (kScoreKernel * kScoreKernel + at.residual * at.residual);
    }
  }
  return score;
}

}  // namespace hulltrack
