#include "daemon/simulator/berth_world.hpp"

#include <utility>

#include "daemon/simulator/berth_mesh.hpp"
#include "daemon/simulator/loader_machine.hpp"

namespace hulltrack {
namespace {

Eigen::Matrix<float, 3, 4> as_affine(const Pose& T) { return T.matrix().topRows<3>().cast<float>(); }

}  // namespace

BerthWorld::BerthWorld(TriangleMesh hull_mesh_H, const LoaderMotion& loader, const HullMotion& hull,
                       const Pose& mount)
    : bodies_{RayScene(boom_mesh()), RayScene(std::move(hull_mesh_H)), RayScene(berth_mesh()),
              RayScene(portal_mesh())},
      loader_(&loader),
      hull_(&hull),
      mount_(mount) {}

Pose BerthWorld::T_W_L(double t) const { return lidar_pose(loader_machine(), loader_->at(t), mount_); }

BerthWorld::Placement BerthWorld::placement(double t) const {
  const Joints joints = loader_->at(t);
  const Pose T_W_L = lidar_pose(loader_machine(), joints, mount_);
  const Pose T_G_L = Eigen::Translation3d(-joints.d_x, 0.0, 0.0) * T_W_L;
  return {as_affine(mount_), as_affine(hull_->T_W_H(t).inverse() * T_W_L), as_affine(T_W_L),
          as_affine(T_G_L)};
}

BerthWorld::Sweep BerthWorld::sweep(double begin, double end) const {
  return {begin, end, placement(begin), placement(end)};
}

std::optional<RayHit> BerthWorld::cast(const Sweep& sweep, double t, const Point& origin_L,
                                       const Point& direction_L, float max_range) const {
  const auto s = static_cast<float>((t - sweep.begin) / (sweep.end - sweep.begin));
  std::optional<RayHit> nearest;
  float reach = max_range;
  for (std::size_t body = 0; body < bodies_.size(); ++body) {
    const Eigen::Matrix<float, 3, 4> T = (1.0F - s) * sweep.at_begin[body] + s * sweep.at_end[body];
    const Point origin = T.leftCols<3>() * origin_L + T.col(3);
    const Point direction = T.leftCols<3>() * direction_L;
    const auto hit = bodies_[body].cast(origin, direction, reach);
    if (!hit) continue;
    if (hit->material == Material::water && displaced(sweep, s, origin_L + hit->distance * direction_L))
      continue;
    nearest = hit;
    reach = hit->distance;
  }
  return nearest;
}

bool BerthWorld::displaced(const Sweep& sweep, float s, const Point& p_L) const {
  const Eigen::Matrix<float, 3, 4> T_H_L = (1.0F - s) * sweep.at_begin[kHull] + s * sweep.at_end[kHull];
  constexpr float kBelowAnyKeel = 20.0F;  // m
  return bodies_[kHull].blocked(T_H_L.leftCols<3>() * p_L + T_H_L.col(3), {0.0F, 0.0F, -1.0F}, kBelowAnyKeel);
}

}  // namespace hulltrack
