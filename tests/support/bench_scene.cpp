#include "tests/support/bench_scene.hpp"

#include <array>
#include <cmath>
#include <limits>
#include <optional>
#include <random>

#include "core/geometry/box.hpp"

namespace hulltrack::bench {
namespace {

constexpr float kDeck = 2.0F;  // height of the deck above W's origin, m
constexpr float kSurveyRange = 25.0F;
constexpr float kMapNoise = 0.005F;  // 1-sigma of a surveyed point, m
constexpr float kScanNoise = 0.02F;  // 1-sigma of a range, m
constexpr std::size_t kAzimuths = 1024;
constexpr std::size_t kChannels = 64;

using Boxes = std::vector<Box>;

void add(Boxes& boxes, float x0, float x1, float y0, float y1, float z0, float z1) {
  boxes.push_back({Point(x0, y0, z0), Point(x1, y1, z1)});
}

void add_hold(Boxes& hull, float x0, float x1, float y0, float y1) {
  constexpr float kWall = 0.35F;  // with its rest bar
  constexpr float kTop = kDeck + 1.2F;
  add(hull, x0 - kWall, x0, y0 - kWall, y1 + kWall, kDeck, kTop);  // coaming
  add(hull, x1, x1 + kWall, y0 - kWall, y1 + kWall, kDeck, kTop);
  add(hull, x0, x1, y0 - kWall, y0, kDeck, kTop);
  add(hull, x0, x1, y1, y1 + kWall, kDeck, kTop);
  add(hull, x0, x1, y0, y1, kDeck - 9.5F, kDeck - 9.0F);  // tank top
  for (float x = x0 + 1.0F; x < x1; x += 2.0F) {          // coaming stays on both long sides
    add(hull, x, x + 0.1F, y0 - 0.9F, y0 - kWall, kDeck, kDeck + 0.9F);
    add(hull, x, x + 0.1F, y1 + kWall, y1 + 0.9F, kDeck, kDeck + 0.9F);
  }
  add(hull, x1 + 0.5F, x1 + 1.2F, y0, y1, kDeck, kTop + 1.5F);  // covers, folded
}

Boxes make_hull() {
  Boxes hull;
  constexpr float kBottom = kDeck - 9.5F;
  add(hull, -60.0F, 60.0F, 0.0F, 4.0F, kBottom, kDeck);  // side decks above the sheer sides
  add(hull, -60.0F, 60.0F, 16.0F, 20.0F, kBottom, kDeck);
  add(hull, -60.0F, -40.0F, 4.0F, 16.0F, kBottom, kDeck);  // below the superstructure
  // No two holds and cross decks are of one length: a scan fits one place along the quay.
  constexpr std::array<float, 5> kHolds{12.0F, 14.5F, 14.0F, 15.0F, 11.0F};
  constexpr std::array<float, 5> kDecks{4.5F, 5.0F, 4.5F, 4.0F, 15.5F};
  float x = -40.0F;
  for (std::size_t i = 0; i < kHolds.size(); ++i) {
    add_hold(hull, x, x + kHolds[i], 4.0F, 16.0F);
    x += kHolds[i];
    add(hull, x, x + kDecks[i], 4.0F, 16.0F, kBottom, kDeck);  // cross deck
    if (i % 2 == 0) {
      add(hull, x + 1.7F, x + 3.7F, 9.0F, 11.0F, kDeck, kDeck + 9.0F);  // crane
    } else {
      add(hull, x + 1.7F, x + 3.3F, 8.0F, 9.5F, kDeck, kDeck + 2.2F);  // mast house
    }
    add(hull, x + 1.5F, x + 1.9F, 5.0F, 5.4F, kDeck, kDeck + 0.8F);  // ventilators
    add(hull, x + 1.5F, x + 1.9F, 14.5F, 14.9F, kDeck, kDeck + 0.8F);
    x += kDecks[i];
  }
  add(hull, -58.0F, -44.0F, 1.5F, 18.5F, kDeck, kDeck + 3.0F);  // superstructure, storey by storey
  add(hull, -57.0F, -45.0F, 2.5F, 17.5F, kDeck + 3.0F, kDeck + 6.0F);
  add(hull, -56.0F, -46.0F, 4.0F, 16.0F, kDeck + 6.0F, kDeck + 9.0F);
  add(hull, -55.0F, -47.0F, 0.5F, 19.5F, kDeck + 9.0F, kDeck + 11.5F);  // bridge with its wings
  add(hull, -54.0F, -52.0F, 9.0F, 11.0F, kDeck + 11.5F, kDeck + 15.0F);
  add(hull, -60.0F, 60.0F, 0.0F, 0.1F, kDeck, kDeck + 1.0F);  // bulwark
  add(hull, -60.0F, 60.0F, 19.9F, 20.0F, kDeck, kDeck + 1.0F);
  add(hull, 59.9F, 60.0F, 0.1F, 19.9F, kDeck, kDeck + 1.0F);
  for (float at = -42.0F; at < 58.0F; at += 12.0F) {  // bollards and lockers
    add(hull, at, at + 0.4F, 1.0F, 1.3F, kDeck, kDeck + 0.6F);
    add(hull, at + 0.8F, at + 1.2F, 1.0F, 1.3F, kDeck, kDeck + 0.6F);
    add(hull, at + 4.0F, at + 5.5F, 18.2F, 19.0F, kDeck, kDeck + 0.9F);
  }
  return hull;
}

Boxes make_clutter() {
  Boxes clutter;
  add(clutter, -140.0F, 140.0F, -60.0F, -1.5F, -12.0F, 0.0F);  // quay
  add(clutter, -90.0F, 90.0F, -22.0F, -21.0F, 0.0F, 9.0F);     // conveyor gallery
  add(clutter, -50.0F, -30.0F, -16.0F, -9.0F, 0.0F, 4.0F);     // stockpiles and a shed
  add(clutter, 10.0F, 35.0F, -18.0F, -8.0F, 0.0F, 5.0F);
  for (int step = 0; step < 6; ++step) {  // cargo heaped in two of the holds
    const float s = 0.9F * static_cast<float>(step);
    const float z = kDeck - 9.0F + 1.1F * static_cast<float>(step);
    add(clutter, -22.0F + s, -10.5F - s, 5.0F + s, 15.0F - s, z, z + 1.1F);
    add(clutter, 16.0F + s, 28.0F - s, 5.0F + s, 15.0F - s, z, z + 1.1F);
  }
  return clutter;
}

// Distance along a ray to the box's near face, in units of the direction; nothing if it misses.
std::optional<float> hit(const Box& box, const Point& from, const Eigen::Array3f& inverse_direction) {
  const Eigen::Array3f a = (box.min - from).array() * inverse_direction;
  const Eigen::Array3f b = (box.max - from).array() * inverse_direction;
  const float enter = a.min(b).maxCoeff();
  const float leave = a.max(b).minCoeff();
  if (enter > leave || enter <= 0.0F) {
    return std::nullopt;
  }
  return enter;
}

Eigen::Array3f inverse(const Point& direction) {
  // A tiny component instead of none keeps 0 * infinity out of the slab test.
  return 1.0F / direction.array().unaryExpr([](float v) { return std::abs(v) < 1e-9F ? 1e-9F : v; });
}

bool is_visible(const Boxes& hull, const Point& from, const Point& point) {
  const Eigen::Array3f inverse_direction = inverse(point - from);
  constexpr float kAlmostThere = 0.9995F;
  for (const Box& box : hull) {
    const std::optional<float> distance = hit(box, from, inverse_direction);
    if (distance && *distance < kAlmostThere) {
      return false;
    }
  }
  return true;
}

std::vector<Point> loader_positions(std::size_t count) {
  std::vector<Point> positions;
  for (std::size_t i = 0; i < count; ++i) {
    const float share = count == 1 ? 0.5F : static_cast<float>(i) / static_cast<float>(count - 1);
    const float sway = static_cast<float>(i % 3);
    positions.emplace_back(-38.0F + 86.0F * share, 5.0F + 3.5F * sway, kDeck + 15.0F + 2.5F * sway);
  }
  return positions;
}

// Grid points of one face (`axis` at `level`) that a survey position sees.
void survey_face(const Boxes& hull, const Box& box, int axis, float level, float spacing,
                 const std::vector<Point>& positions, std::mt19937& rng, Cloud& map) {
  std::normal_distribution<float> noise(0.0F, kMapNoise);
  const int u = (axis + 1) % 3;
  const int v = (axis + 2) % 3;
  for (float s = box.min[u] + 0.5F * spacing; s < box.max[u]; s += spacing) {
    for (float t = box.min[v] + 0.5F * spacing; t < box.max[v]; t += spacing) {
      Point p;
      p[axis] = level;
      p[u] = s;
      p[v] = t;
      for (const Point& from : positions) {
        if ((from - p).squaredNorm() < kSurveyRange * kSurveyRange && is_visible(hull, from, p)) {
          map.push_back(p + Point(noise(rng), noise(rng), noise(rng)));
          break;
        }
      }
    }
  }
}

Cloud survey(const Boxes& hull, float spacing, std::mt19937& rng) {
  Cloud map;
  const std::vector<Point> positions = loader_positions(9);
  for (const Box& box : hull) {
    for (int axis = 0; axis < 3; ++axis) {
      survey_face(hull, box, axis, box.min[axis], spacing, positions, rng, map);
      survey_face(hull, box, axis, box.max[axis], spacing, positions, rng, map);
    }
  }
  return map;
}

RayHit first_hit(const Boxes& hull, const Boxes& clutter, const Point& from, const Point& direction) {
  const Eigen::Array3f inverse_direction = inverse(direction);
  RayHit first{std::numeric_limits<float>::infinity(), false};
  for (const Boxes* boxes : {&hull, &clutter}) {
    for (const Box& box : *boxes) {
      const std::optional<float> distance = hit(box, from, inverse_direction);
      if (distance && *distance < first.range) {
        first = {*distance, boxes == &hull};
      }
    }
  }
  return first;
}

SceneScan scan_from(const Boxes& hull, Boxes clutter, const Point& sensor, std::mt19937& rng) {
  // The chute hangs below the sensor.
  clutter.push_back({sensor - Point(0.6F, -1.5F, 14.0F), sensor - Point(-0.6F, -2.7F, 1.0F)});
  std::normal_distribution<float> noise(0.0F, kScanNoise);
  std::uniform_real_distribution<float> u(0.0F, 1.0F);
  SceneScan scan;
  for (std::size_t i = 0; i < kAzimuths; ++i) {
    for (std::size_t channel = 0; channel < kChannels; ++channel) {
      const double azimuth = radians(360.0 * static_cast<double>(i) / kAzimuths);
      const double elevation = radians(-89.0 + 39.0 * static_cast<double>(channel) / kChannels);
      const Point direction = Eigen::Vector3d(std::cos(elevation) * std::cos(azimuth),
                                              std::cos(elevation) * std::sin(azimuth), std::sin(elevation))
                                  .cast<float>();
      auto [range, on_hull] = first_hit(hull, clutter, sensor, direction);
      if (u(rng) < 0.02F) {  // dust near the chute
        range = std::min(range, 2.0F + 10.0F * u(rng));
        on_hull = false;
      }
      if (range < 120.0F) {
        scan.cloud_W.push_back(sensor + (range + noise(rng)) * direction);
        scan.hull_points += on_hull ? 1 : 0;
      }
    }
  }
  return scan;
}

}  // namespace

Scene make_scene(double spacing, std::size_t scans, std::uint32_t seed) {
  std::mt19937 rng(seed);
  const Boxes hull = make_hull();
  const Boxes clutter = make_clutter();
  Scene scene;
  scene.map_H = survey(hull, static_cast<float>(spacing), rng);
  for (const Point& sensor : loader_positions(scans)) {
    scene.scans.push_back(scan_from(hull, clutter, sensor, rng));
  }
  return scene;
}

RayTarget::RayTarget() : hull_(make_hull()), clutter_(make_clutter()) {}

RayHit RayTarget::cast(const Point& from, const Point& direction) const {
  return first_hit(hull_, clutter_, from, direction);
}

Pose start_pose(double translation, double angle, std::uint32_t seed) {
  std::mt19937 rng(seed);
  std::normal_distribution<double> n;
  const Eigen::Vector3d middle(0.0, 10.0, 2.0);
  const Eigen::Vector3d direction = Eigen::Vector3d(n(rng), n(rng), n(rng)).normalized();
  const Eigen::Vector3d axis = Eigen::Vector3d(n(rng), n(rng), n(rng)).normalized();
  Pose T = Pose::Identity();
  T.linear() = so3_exp(angle * axis);
  T.translation() = middle + translation * direction - T.linear() * middle;
  return T;
}

}  // namespace hulltrack::bench
