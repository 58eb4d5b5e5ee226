#include "daemon/simulator/survey.hpp"

#include <algorithm>
#include <cmath>
#include <unordered_set>

#include "daemon/simulator/parallel.hpp"
#include "daemon/simulator/random.hpp"
#include "daemon/simulator/ray_scene.hpp"

namespace hulltrack {
namespace {

constexpr float kSampleSpacing = 0.045F;   // m: 1.2 rays a voxel, so that a survey leaves few voxels empty
constexpr float kVoxel = 0.05F;            // m
constexpr float kRangeSigma = 0.005F;      // m, after averaging many frames
constexpr float kMaxRange = 60.0F;         // m
constexpr float kMinCosIncidence = 0.12F;  // 83 deg
constexpr std::size_t kNearestStations = 8;

/// Index of the 5 cm voxel around p: 21 bits an axis reach 52 km.
std::uint64_t voxel_of(const Point& p) {
  const auto axis = [](float v) {
    constexpr std::int64_t kOffset = 1 << 20;
    return static_cast<std::uint64_t>(static_cast<std::int64_t>(std::floor(v / kVoxel)) + kOffset);
  };
  return axis(p.x()) | (axis(p.y()) << 21U) | (axis(p.z()) << 42U);
}

/// The survey of one triangle.
class TriangleSurvey {
 public:
  TriangleSurvey(const RayScene& scene, const std::vector<Point>& stations)
      : scene_(scene), stations_(stations) {}

  void run(std::size_t triangle, std::uint64_t seed, Cloud& out) const {
    const TriangleMesh& mesh = scene_.mesh();
    const auto& corners = mesh.triangles[triangle];
    const Point& a = mesh.vertices[corners[0]];
    const Point u = mesh.vertices[corners[1]] - a;
    const Point v = mesh.vertices[corners[2]] - a;
    const Point normal = u.cross(v);
    const float area = 0.5F * normal.norm();
    const std::vector<Point> stations = nearest_stations(a + (u + v) / 3.0F);
    RandomStream random(seed, 400, triangle);
    const auto samples =
        static_cast<int>(area / (kSampleSpacing * kSampleSpacing) + static_cast<float>(random.uniform()));
    for (int i = 0; i < samples; ++i) {
      auto s = static_cast<float>(random.uniform());
      auto t = static_cast<float>(random.uniform());
      if (s + t > 1.0F) {
        s = 1.0F - s;
        t = 1.0F - t;
      }
      const Point p = a + s * u + t * v;
      const auto noise = kRangeSigma * static_cast<float>(random.gaussian());
      if (const Point* station = seen_from(stations, p, normal.normalized()))
        out.push_back(p + noise * (p - *station).normalized());
    }
  }

 private:
  [[nodiscard]] std::vector<Point> nearest_stations(const Point& p) const {
    std::vector<Point> nearest = stations_;
    std::sort(nearest.begin(), nearest.end(),
              [&](const Point& l, const Point& r) { return (l - p).squaredNorm() < (r - p).squaredNorm(); });
    nearest.resize(std::min(kNearestStations, nearest.size()));
    return nearest;
  }

  /// The first of `stations` that sees p; nullptr if none does.
  const Point* seen_from(const std::vector<Point>& stations, const Point& p, const Point& normal) const {
    for (const Point& station : stations) {
      const Point ray = p - station;
      const float range = ray.norm();
      if (range > kMaxRange || std::abs(normal.dot(ray)) < kMinCosIncidence * range) continue;
      constexpr float kJustBefore = 0.999F;  // do not meet the surface that is looked for
      if (!scene_.blocked(station, ray, kJustBefore)) return &station;
    }
    return nullptr;
  }

  const RayScene& scene_;
  const std::vector<Point>& stations_;
};

}  // namespace

Cloud survey(const TriangleMesh& hull_mesh_H, const std::vector<Point>& stations_H, std::uint64_t seed) {
  const RayScene scene(hull_mesh_H);
  const TriangleSurvey one(scene, stations_H);
  std::vector<Cloud> of_triangle(hull_mesh_H.triangles.size());
  for_each_index(of_triangle.size(), [&](std::size_t i) { one.run(i, seed, of_triangle[i]); });

  Cloud map;
  std::unordered_set<std::uint64_t> taken;
  for (const Cloud& cloud : of_triangle)
    for (const Point& p : cloud)
      if (taken.insert(voxel_of(p)).second) map.push_back(p);
  return map;
}

}  // namespace hulltrack
