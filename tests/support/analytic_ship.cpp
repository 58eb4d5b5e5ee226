#include "tests/support/analytic_ship.hpp"

#include <cmath>

namespace hulltrack::testing {
namespace {

constexpr double kFarthest = 200.0;

bool within(const Rectangle& r, const Eigen::Vector3d& p) {
  for (int i = 0; i < 3; ++i) {
    if (i != r.axis && (p[i] < r.low[i] || p[i] > r.high[i])) {
      return false;
    }
  }
  return true;
}

}  // namespace

AnalyticShip AnalyticShip::bulk_carrier() {
  AnalyticShip ship;
  ship.add(2, 0.0, {-30, -10, 0}, {-20, 10, 0});  // deck around the hatches
  ship.add(2, 0.0, {-5, -10, 0}, {3, 10, 0});
  ship.add(2, 0.0, {18, -10, 0}, {30, 10, 0});
  ship.add(2, 0.0, {-20, -10, 0}, {-5, -6, 0});
  ship.add(2, 0.0, {-20, 6, 0}, {-5, 10, 0});
  ship.add(2, 0.0, {3, -10, 0}, {18, -6, 0});
  ship.add(2, 0.0, {3, 6, 0}, {18, 10, 0});
  ship.add_hatch(-20, -5, 6, 1.4);
  ship.add_hatch(3, 18, 6, 1.4);
  ship.add(1, -10.0, {-30, 0, -4}, {30, 0, 0});
  ship.add(1, 10.0, {-30, 0, -4}, {30, 0, 0});
  ship.add_box({-30, -9, 0}, {-25, 9, 8});       // house
  ship.add_box({-2.5, -7, 0}, {-1.0, -5, 1.2});  // winch
  ship.add_box({0.0, 4, 0}, {0.8, 5.5, 2.0});    // vent
  ship.add_box({20.0, -3, 0}, {22, 0.5, 0.9});   // store
  ship.add_box({25.0, 5, 0}, {26, 8, 1.5});
  return ship;
}

AnalyticShip AnalyticShip::other_carrier() {
  AnalyticShip ship;
  ship.add(2, 0.6, {-30, -11, 0}, {30, 11, 0});
  ship.add_box({-17, -7.5, 0.6}, {-7, 7.5, 2.6});  // closed hatches
  ship.add_box({-3, -7.5, 0.6}, {9, 7.5, 2.6});
  ship.add_box({14, -7.5, 0.6}, {24, 7.5, 2.6});
  ship.add(1, -11.0, {-30, 0, -4}, {30, 0, 0.6});
  ship.add(1, 11.0, {-30, 0, -4}, {30, 0, 0.6});
  return ship;
}

void AnalyticShip::add_box(const Eigen::Vector3d& low, const Eigen::Vector3d& high) {
  for (int axis = 0; axis < 3; ++axis) {
    add(axis, low[axis], low, high);
    add(axis, high[axis], low, high);
  }
}

void AnalyticShip::add_hatch(double x0, double x1, double half_width, double height) {
  constexpr double kFloor = -6.0;
  add(0, x0, {0, -half_width, kFloor}, {0, half_width, height});
  add(0, x1, {0, -half_width, kFloor}, {0, half_width, height});
  add(1, -half_width, {x0, 0, kFloor}, {x1, 0, height});
  add(1, half_width, {x0, 0, kFloor}, {x1, 0, height});
  add(2, kFloor, {x0, -half_width, 0}, {x1, half_width, 0});
}

Cloud AnalyticShip::map(double spacing, unsigned seed) const {
  std::mt19937 random(seed);
  std::normal_distribution<double> noise(0.0, 0.005);
  Cloud cloud;
  for (const Rectangle& r : rectangles_) {
    const int u = (r.axis + 1) % 3;
    const int v = (r.axis + 2) % 3;
    for (double a = r.low[u] + spacing / 2; a < r.high[u]; a += spacing) {
      for (double b = r.low[v] + spacing / 2; b < r.high[v]; b += spacing) {
        Eigen::Vector3d p;
        p[r.axis] = r.at;
        p[u] = a;
        p[v] = b;
        cloud.push_back((p + Eigen::Vector3d(noise(random), noise(random), noise(random))).cast<float>());
      }
    }
  }
  return cloud;
}

std::optional<double> AnalyticShip::cast(const Eigen::Vector3d& origin_H,
                                         const Eigen::Vector3d& ray_H) const {
  double nearest = kFarthest;
  for (const Rectangle& r : rectangles_) {
    const double t = (r.at - origin_H[r.axis]) / ray_H[r.axis];
    if (t > 0.01 && t < nearest && within(r, origin_H + t * ray_H)) {
      nearest = t;
    }
  }
  return nearest < kFarthest ? std::optional(nearest) : std::nullopt;
}

const std::shared_ptr<const HullMap>& bulk_carrier_map() {
  static const auto map = std::make_shared<const HullMap>(AnalyticShip::bulk_carrier().map(0.07, 1));
  return map;
}

SensorConfig looking_down(const Eigen::Vector3d& position_W) {
  SensorConfig sensor;
  sensor.mount.linear() = rotation_from_rpy({0.0, radians(90.0), 0.0});
  sensor.mount.translation() = position_W;
  return sensor;
}

Scan scan_ship(const AnalyticShip* ship, const SensorConfig& sensor, const ScanOptions& options) {
  std::mt19937 random(options.seed + 1000 * options.frame);
  std::normal_distribution<double> noise(0.0, options.range_sigma);
  std::uniform_real_distribution<double> unit(0.0, 1.0);
  const Pose T_H_L = options.T_W_H.inverse() * sensor.mount;
  Scan scan;
  scan.frame_number = options.frame;
  scan.begin = MeasurementTime{options.frame * std::chrono::milliseconds(100)};
  scan.end = scan.begin + std::chrono::milliseconds(100);
  scan.first_firing = scan.begin;
  scan.last_firing = scan.end - std::chrono::microseconds(10);
  scan.lidars.resize(1);
  constexpr int kColumns = 344;
  for (int column = 0; column < kColumns; ++column) {
    const double azimuth = radians(-60.0 + 120.0 * column / (kColumns - 1));
    const auto first = static_cast<std::uint32_t>(scan.points.size());
    for (int row = 0; row <= 64; ++row) {
      const double elevation = radians(-45.0 + 90.0 * row / 64.0);
      const Eigen::Vector3d ray_L(std::cos(elevation) * std::cos(azimuth),
                                  std::cos(elevation) * std::sin(azimuth), std::sin(elevation));
      const Eigen::Vector3d ray_W = sensor.mount.linear() * ray_L;
      double range = (-5.0 - sensor.mount.translation().z()) / ray_W.z();  // the quay
      if (const auto hit =
              ship != nullptr ? ship->cast(T_H_L.translation(), T_H_L.linear() * ray_L) : std::nullopt) {
        range = *hit;
      }
      if (range <= 0.0 || range > kFarthest || unit(random) < options.drop) {
        continue;
      }
      const Eigen::Vector3f p = ((range + noise(random)) * ray_L).cast<float>();
      scan.points.push_back({p.x(), p.y(), p.z(), 0, 100, static_cast<std::uint8_t>(row), 0});
    }
    const auto count = static_cast<std::uint32_t>(scan.points.size()) - first;
    scan.segments.push_back(
        {scan.begin + (2 * column + 1) * (scan.end - scan.begin) / (2 * kColumns), first, count, 0});
  }
  return scan;
}

JointHistory joints_at_rest(double seconds) {
  JointHistory history(100'000);
  for (int i = -50; i * 0.02 <= seconds; ++i) {
    history.add({MeasurementTime{i * std::chrono::milliseconds(20)}, {}});
  }
  return history;
}

}  // namespace hulltrack::testing
