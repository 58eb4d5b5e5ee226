#include "tests/support/any_cloud.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <memory>
#include <stdexcept>
#include <utility>

#include "core/geometry/box.hpp"
#include "core/map/hull_map.hpp"
#include "core/map/stray_points.hpp"
#include "core/quay/quay_map.hpp"
#include "core/tracking/hull_tracker.hpp"
#include "core/tracking/map_judge.hpp"

namespace hulltrack::test {
namespace {

constexpr float kFarthest = 10'000.0F;  // m
constexpr std::size_t kMostBytes = 32;  // of one thing

/// Takes numbers off the front; zeros when the bytes are used up.
class Bytes {
 public:
  explicit Bytes(std::span<const std::uint8_t> bytes) : rest_(bytes) {}
  [[nodiscard]] bool empty() const { return rest_.empty(); }

  template <typename T>
  T take() {
    std::array<std::uint8_t, sizeof(T)> raw{};
    const std::size_t count = std::min(raw.size(), rest_.size());
    std::copy_n(rest_.begin(), count, raw.begin());
    rest_ = rest_.subspan(count);
    T value{};
    std::memcpy(&value, raw.data(), sizeof value);
    return value;
  }
  /// In whole centimetres within +-327 m.
  float centimetres() { return 0.01F * static_cast<float>(take<std::int16_t>()); }
  /// 0 to `most`, m.
  float size(float most) { return most * static_cast<float>(take<std::uint8_t>()) / 255.0F; }
  Point place() {
    const float x = centimetres();
    const float y = centimetres();
    return {x, 0.2F * y, 0.05F * centimetres()};
  }

 private:
  std::span<const std::uint8_t> rest_;
};

class Maker {
 public:
  Maker(std::span<const std::uint8_t> bytes, std::size_t most) : bytes_(bytes), most_(most) {}

  Cloud make() && {
    while (!bytes_.empty() && cloud_.size() < most_) {
      add_thing();
    }
    if (cloud_.empty()) {
      cloud_.emplace_back(0.0F, 0.0F, 0.0F);
    }
    return std::move(cloud_);
  }

 private:
  void add(const Point& p) {
    if (cloud_.size() < most_ && (p.array().abs() <= kFarthest).all()) {  // false for NaN
      cloud_.push_back(p);
    }
  }

  /// A parallelogram with a point each `step` (m) along both sides.
  void add_sheet(const Point& corner, const Point& u, const Point& v, float step) {
    const auto steps = [&](const Point& side) { return static_cast<int>(side.norm() / step); };
    for (int i = 0; i <= steps(u); ++i) {
      for (int j = 0; j <= steps(v) && cloud_.size() < most_; ++j) {
        add(corner + static_cast<float>(i) / static_cast<float>(std::max(1, steps(u))) * u +
            static_cast<float>(j) / static_cast<float>(std::max(1, steps(v))) * v);
      }
    }
  }

  void add_open_box(const Point& corner, const Point& size, float step) {
    const Point x(size.x(), 0.0F, 0.0F);
    const Point y(0.0F, size.y(), 0.0F);
    const Point z(0.0F, 0.0F, size.z());
    add_sheet(corner, x, y, step);
    add_sheet(corner, x, z, step);
    add_sheet(corner, y, z, step);
    add_sheet(corner + y, x, z, step);
    add_sheet(corner + x, y, z, step);
  }

  void add_thing() {
    const std::uint8_t what = bytes_.take<std::uint8_t>();
    const float step = 0.03F + bytes_.size(0.7F);
    switch (what % 9) {
      case 0:
        for (int i = 0; i < what / 9; ++i) {
          const auto x = bytes_.take<float>();
          const auto y = bytes_.take<float>();
          add({x, y, bytes_.take<float>()});
        }
        break;
      case 1: {
        const Point corner = bytes_.place();
        const float length = bytes_.size(60.0F);
        add_sheet(corner, {length, 0.1F * bytes_.size(10.0F), 0.0F},
                  {0.0F, bytes_.size(30.0F), bytes_.size(3.0F)}, step);
        break;
      }
      case 2: {
        const Point corner = bytes_.place();
        const float length = bytes_.size(20.0F);
        const float width = bytes_.size(20.0F);
        add_open_box(corner, {length, width, bytes_.size(12.0F)}, step);
        break;
      }
      case 3: {  // a hold in a hold
        const Point corner = bytes_.place();
        const float side = 0.5F + bytes_.size(6.0F);
        add_open_box(corner, {side, side, 5.0F}, step);
        const float inner = bytes_.size(side);
        add_open_box(corner + Point(bytes_.size(side), bytes_.size(side), -3.0F), {inner, inner, 4.0F}, step);
        break;
      }
      case 4:
        for (int i = 0; i < what / 9; ++i) {
          add(bytes_.place());
        }
        break;
      case 5: {
        const Point from = bytes_.place();
        const Point to = bytes_.place();
        add_sheet(from, to - from, Point::Zero(), step);
        break;
      }
      case 6: {
        const float scale = kFarthest / 32'768.0F;
        add(scale *
            Point(bytes_.take<std::int16_t>(), bytes_.take<std::int16_t>(), bytes_.take<std::int16_t>()));
        break;
      }
      case 7: {
        const Point again = cloud_.empty() ? bytes_.place() : cloud_.back();
        for (int i = 0; i < what; ++i) {
          add(again);
        }
        break;
      }
      default: {
        const Point shift = (what & 16) != 0 ? Point(20.0F * bytes_.place()) : bytes_.place();
        for (std::size_t i = 0, all = cloud_.size(); i < all; ++i) {
          add(cloud_[i] + shift);
        }
      }
    }
  }

  Bytes bytes_;
  std::size_t most_;
  Cloud cloud_;
};

void require(bool so, const char* what) {
  if (!so) {
    throw std::logic_error(what);
  }
}

void look_through(const HullMap& map) {
  require(map.length() > 0.0 && std::isfinite(map.length()), "a length that is none");
  require(map.surfels().size() == map.subset_H().size(), "a surfel for each point of the subset");
  std::vector<OccupancyGrid::Index> cells;
  for (std::size_t i = 0; i < map.subset_H().size(); i += map.subset_H().size() / 50 + 1) {
    cells.push_back(map.occupancy().cell_of(map.subset_H()[i]));
  }
  for (int x = -2; x <= 2; ++x) {
    std::array<std::uint16_t, OccupancyGrid::kHeights> values{};
    map.occupancy().correlate(cells, x, -x, values);
    require(x != 0 || values[OccupancyGrid::kUp] == 2 * cells.size(),
            "the map does not occupy its own cells");
  }
  std::size_t seen = 0;
  map.occluders_H().sight_within(
      {.range = 50.0F}, Pose::Identity(),
      [&seen](const Sightings& from_L, std::size_t i) { seen += from_L.range2[i] >= 0.0F ? 1 : 0; });
  require(seen <= map.occluders_H().points().size(), "more is seen than is there");
  for (const Surfel& surfel : map.surfels()) {
    require(surfel.normal_H.allFinite() && surfel.centre_H.allFinite(), "a surfel that is none");
    require(surfel.landmark == Surfel::kNoLandmark || surfel.landmark < map.landmarks().size(),
            "a landmark that is none");
  }
  for (const RimPoint& rim : map.rims()) {
    require(rim.p_H.allFinite() && rim.across_H.allFinite(), "a rim that is none");
    require(map.tree().nearest(rim.p_H, 1.0F).has_value(), "a rim where no map is");
  }
  for (const PlaneMap::Plane& plane : map.planes().planes()) {
    require(plane.centre_H.allFinite() && plane.normal_H.allFinite(), "a plane that is none");
  }
}

/// What the map shows of itself to a LiDAR 15 m above its middle, a few hundred returns; joints at zero.
Scan scan_of(const HullMap& map, const Eigen::Vector3d& sensor_W, std::uint32_t frame) {
  Scan scan;
  scan.frame_number = frame;
  scan.begin = MeasurementTime{frame * std::chrono::milliseconds(100)};
  scan.end = scan.begin + std::chrono::milliseconds(100);
  scan.first_firing = scan.begin;
  scan.last_firing = scan.mid_time();
  scan.lidars.resize(1);
  const Cloud& seen = map.subset_H();
  for (std::size_t i = 0; i < seen.size(); i += seen.size() / 400 + 1) {
    const Point p_L = seen[i] - sensor_W.cast<float>();
    scan.points.push_back({p_L.x(), p_L.y(), p_L.z(), 0, 100, 0, 0});
  }
  scan.segments.push_back({scan.mid_time(), 0, static_cast<std::uint32_t>(scan.points.size()), 0});
  return scan;
}

void track_on(std::shared_ptr<const HullMap> map, const TrackerConfig& config) {
  const Box box = bounding_box(map->subset_H());
  SensorConfig sensor;
  sensor.mount.translation() = (0.5F * (box.min + box.max)).cast<double>() + Eigen::Vector3d(0.0, 0.0, 15.0);
  JointHistory joints(100);
  for (int i = -10; i < 30; ++i) {
    joints.add({MeasurementTime{i * std::chrono::milliseconds(20)}, {}});
  }
  HullTracker tracker(config, {}, {sensor}, map);
  for (std::uint32_t frame = 0; frame < 2; ++frame) {
    const TrackResult result =
        tracker.process(scan_of(*map, sensor.mount.translation(), frame), joints, FrameInputs{});
    require(result.pose.T_W_H.matrix().allFinite(), "a pose that is none");
    require(!result.health, "health before the berth was searched");
  }
}

}  // namespace

Cloud any_cloud(std::span<const std::uint8_t> bytes, std::size_t most) { return Maker(bytes, most).make(); }

std::vector<std::uint8_t> any_bytes(std::mt19937& random, std::size_t things) {
  std::vector<std::uint8_t> bytes(things * kMostBytes);
  for (std::uint8_t& byte : bytes) {
    byte = static_cast<std::uint8_t>(random());
  }
  return bytes;
}

void use_as_map(Cloud cloud) {
  const QuayMap quay(cloud);  // any cloud may be named as the quay's as well
  require(quay.planes().size() == quay.tree().size(), "a plane of the quay has no middle");
  for (const Point& p : cloud) {
    const NearCells::Answer answer = quay.things().at(p);
    require(answer.near || !(p.cwiseAbs().maxCoeff() < 1e5F), "a thing of the quay is not near itself");
    require(answer.near || !answer.inside_level, "inside a surface that is not there");
    require(quay.things().in_reach(p) || !answer.near, "near what the map does not reach");
  }
  static_cast<void>(take_out_strays(cloud));
  TrackerConfig config;
  config.hull.region = Box{{-100.0F, -20.0F, -10.0F}, {100.0F, 40.0F, 30.0F}};
  for (const MapFinding& finding : judge_cloud(cloud, config)) {
    require(!finding.message.empty(), "a finding without words");
  }
  const auto map = std::make_shared<const HullMap>(std::move(cloud));
  look_through(*map);
  for (const MapFinding& finding : judge_map(*map)) {
    require(!finding.message.empty(), "a finding without words");
  }
  track_on(map, config);
}

}  // namespace hulltrack::test
