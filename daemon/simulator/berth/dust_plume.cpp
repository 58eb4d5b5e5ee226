#include "daemon/simulator/berth/dust_plume.hpp"

#include <algorithm>
#include <cmath>

#include "daemon/simulator/berth/loader_machine.hpp"

namespace hulltrack {
namespace {

constexpr double kPuffSize = 1.5;                // m
const Eigen::Vector3d kDrift = {0.8, 0.3, 0.6};  // m/s of the dusty air
constexpr float kStep = 0.5F;                    // m along a ray

struct Interval {
  float begin, end;
};

/// The part of a ray inside the upright cylinder around the plume.
Interval inside(const Point& from_top, const Point& direction, float reach) {
  const auto across = direction.head<2>();
  const auto offset = from_top.head<2>();
  const float a = across.squaredNorm();
  const float b = offset.dot(across);
  const float c = offset.squaredNorm() - DustPlume::kBottomRadius * DustPlume::kBottomRadius;
  Interval result{0.0F, reach};
  if (a > 1e-9F) {
    const float discriminant = b * b - a * c;
    if (discriminant <= 0.0F) return {0.0F, 0.0F};
    result = {std::max(0.0F, (-b - std::sqrt(discriminant)) / a),
              std::min(reach, (-b + std::sqrt(discriminant)) / a)};
  } else if (c > 0.0F) {
    return {0.0F, 0.0F};
  }
  if (std::abs(direction.z()) < 1e-6F) {
    const bool within = from_top.z() < 0.0F && from_top.z() > -DustPlume::kDepth;
    return within ? result : Interval{0.0F, 0.0F};
  }
  const float top = -from_top.z() / direction.z();
  const float bottom = (-DustPlume::kDepth - from_top.z()) / direction.z();
  return {std::max(result.begin, std::min(top, bottom)), std::min(result.end, std::max(top, bottom))};
}

double smooth(double s) { return s * s * (3.0 - 2.0 * s); }

}  // namespace

DustPlume::Now DustPlume::at(double t) const {
  constexpr int kMemory = 8;  // looks back over 4 s
  int pouring = 0;
  for (int i = 0; i < kMemory; ++i) pouring += loader_->at_rest(t - 0.5 * i) ? 1 : 0;
  const Pose T_W_B = lidar_pose(loader_machine(), loader_->at(t), Pose::Identity());
  const Eigen::Vector3d chute_end_W = T_W_B * chute_end_B().cast<double>();
  return {t, chute_end_W.cast<float>() + Point(0.0F, 0.0F, kRise), static_cast<double>(pouring) / kMemory};
}

std::optional<float> DustPlume::stops(const Now& now, const Point& origin_W, const Point& direction_W,
                                      float reach, RandomStream& random) const {
  if (density_ <= 0.0 || now.strength <= 0.0) return std::nullopt;
  const Interval part = inside(origin_W - now.top_W, direction_W, reach);
  if (part.end <= part.begin) return std::nullopt;
  const double endurance = -std::log(1.0 - random.uniform());  // Beer and Lambert
  double depth = 0.0;
  for (float s = part.begin + 0.5F * kStep; s < part.end; s += kStep) {
    depth += density(now, origin_W + s * direction_W) * static_cast<double>(kStep);
    if (depth > endurance) return s + kStep * static_cast<float>(random.uniform() - 0.5);
  }
  return std::nullopt;
}

double DustPlume::density(const Now& now, const Point& p_W) const {
  const Point below = p_W - now.top_W;
  const double radius = std::lerp(static_cast<double>(kTopRadius), static_cast<double>(kBottomRadius),
                                  static_cast<double>(-below.z() / kDepth));
  const double away = static_cast<double>(below.head<2>().norm()) / radius;
  if (away > 1.0) return 0.0;
  const double puff = noise((p_W.cast<double>() - now.t * kDrift) / kPuffSize);
  constexpr double kClearShare = 0.25;  // of the noise's range that is clear air
  return density_ * now.strength * (1.0 - away * away) * std::max(0.0, puff - kClearShare) /
         (1.0 - kClearShare);
}

/// Smooth in space: random numbers on a grid, interpolated; [0, 1].
double DustPlume::noise(const Eigen::Vector3d& p) const {
  const Eigen::Vector3d floor = p.array().floor();
  const Eigen::Vector3d s = (p - floor).unaryExpr(&smooth);
  double sum = 0.0;
  for (int corner = 0; corner < 8; ++corner) {
    std::uint64_t key = 0;
    double weight = 1.0;
    for (int axis = 0; axis < 3; ++axis) {
      const int bit = (corner >> axis) & 1;
      constexpr std::int64_t kOffset = 1 << 20;
      key = key << 21U | static_cast<std::uint64_t>(static_cast<std::int64_t>(floor[axis]) + bit + kOffset);
      weight *= bit == 1 ? s[axis] : 1.0 - s[axis];
    }
    sum += weight * RandomStream(seed_, 620, key).uniform();
  }
  return sum;
}

}  // namespace hulltrack
