#include "daemon/simulator/berth/survey.hpp"

#include <algorithm>
#include <cmath>
#include <unordered_set>

#include "daemon/simulator/parallel.hpp"
#include "daemon/simulator/random.hpp"
#include "daemon/simulator/sensing/ray_scene.hpp"

namespace hulltrack {
namespace {

constexpr float kSampleSpacing = 0.9F;     // voxels: 1.2 rays a voxel, so that a survey leaves few empty
constexpr float kRangeSigma = 0.005F;      // m, after averaging many frames
constexpr float kMaxRange = 60.0F;         // m
constexpr float kMinCosIncidence = 0.12F;  // 83 deg
constexpr std::size_t kNearestStations = 8;

/// Index of the voxel around p: 21 bits an axis reach 52 km at 5 cm.
std::uint64_t voxel_of(const Point& p, float voxel) {
  const auto axis = [voxel](float v) {
    constexpr std::int64_t kOffset = 1 << 20;
    return static_cast<std::uint64_t>(static_cast<std::int64_t>(std::floor(v / voxel)) + kOffset);
  };
  return axis(p.x()) | (axis(p.y()) << 21U) | (axis(p.z()) << 42U);
}

/// The survey of one triangle.
class TriangleSurvey {
 public:
  TriangleSurvey(const RayScene& scene, const std::vector<Point>& stations, float voxel)
      : scene_(scene), stations_(stations), spacing_(kSampleSpacing * voxel) {}

  void run(std::size_t triangle, std::uint64_t seed, Cloud& out) const {
    const TriangleMesh& mesh = scene_.mesh();
    const auto& corners = mesh.triangles[triangle];
    const Point& a = mesh.vertices[corners[0]];
    const Point u = mesh.vertices[corners[1]] - a;
    const Point v = mesh.vertices[corners[2]] - a;
    const Point normal = u.cross(v);
    const float area = 0.5F * normal.norm();
    const Point centre = a + (u + v) / 3.0F;
    const std::vector<Point> stations = nearest_stations(centre);
    const float size = std::max({(a - centre).norm(), (a + u - centre).norm(), (a + v - centre).norm()});
    if ((stations.front() - centre).norm() > kMaxRange + size) return;
    RandomStream random(seed, 400, triangle);
    const auto samples =
        static_cast<int>(area / (spacing_ * spacing_) + static_cast<float>(random.uniform()));
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
  float spacing_;  // of samples, m
};

}  // namespace

Cloud survey(const TriangleMesh& mesh, const std::vector<Point>& stations, std::uint64_t seed, float voxel) {
  const RayScene scene(mesh);
  const TriangleSurvey one(scene, stations, voxel);
  std::vector<Cloud> of_triangle(mesh.triangles.size());
  for_each_index(of_triangle.size(), [&](std::size_t i) { one.run(i, seed, of_triangle[i]); });

  Cloud map;
  std::unordered_set<std::uint64_t> taken;
  for (const Cloud& cloud : of_triangle)
    for (const Point& p : cloud)
      if (taken.insert(voxel_of(p, voxel)).second) map.push_back(p);
  return map;
}

}  // namespace hulltrack
