#include "core/geometry/sighting.hpp"

#include <cassert>
#include <cmath>

#include "core/geometry/spherical_grid.hpp"

namespace hulltrack {
namespace {

[[gnu::always_inline]] inline void sight_lanes(std::span<const Point> points, const Eigen::Matrix3f& R,
                                               const Point& t, Sightings& out) {
  float px[Sightings::kBlock] = {};
  float py[Sightings::kBlock] = {};
  float pz[Sightings::kBlock] = {};
  for (std::size_t i = 0; i < points.size(); ++i) {
    px[i] = points[i].x();
    py[i] = points[i].y();
    pz[i] = points[i].z();
  }
  // Always whole blocks: the compiler vectorises loops of a fixed length.
  for (std::size_t i = 0; i < Sightings::kBlock; ++i) {
    out.x[i] = R(0, 0) * px[i] + R(0, 1) * py[i] + R(0, 2) * pz[i] + t.x();
    out.y[i] = R(1, 0) * px[i] + R(1, 1) * py[i] + R(1, 2) * pz[i] + t.y();
    out.z[i] = R(2, 0) * px[i] + R(2, 1) * py[i] + R(2, 2) * pz[i] + t.z();
  }
  for (std::size_t i = 0; i < Sightings::kBlock; ++i) {
    const float planar2 = out.x[i] * out.x[i] + out.y[i] * out.y[i];
    out.range2[i] = planar2 + out.z[i] * out.z[i];
    const int row = SphericalGrid::row(std::sqrt(planar2), out.z[i]);
    const int column = SphericalGrid::column(out.x[i], out.y[i]);
    out.cell[i] = static_cast<std::uint32_t>(row * SphericalGrid::kColumns + column);
  }
}

// The same function, compiled for two processors: without contraction to fused operations both give the same
// bits.
[[gnu::target("avx2")]] void sight_avx2(std::span<const Point> points, const Eigen::Matrix3f& R,
                                        const Point& t, Sightings& out) {
  sight_lanes(points, R, t, out);
}

void sight_sse2(std::span<const Point> points, const Eigen::Matrix3f& R, const Point& t, Sightings& out) {
  sight_lanes(points, R, t, out);
}

}  // namespace

void sight_block(std::span<const Point> points, const Eigen::Matrix3f& R, const Point& t, Sightings& out) {
  assert(points.size() <= Sightings::kBlock);
  static const auto sight_best = __builtin_cpu_supports("avx2") != 0 ? sight_avx2 : sight_sse2;
  sight_best(points, R, t, out);
}

}  // namespace hulltrack
