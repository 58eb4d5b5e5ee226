#include "daemon/simulator/berth/berth_world.hpp"

#include "daemon/simulator/berth/berth_mesh.hpp"
#include "daemon/simulator/berth/loader_machine.hpp"

namespace hulltrack {
namespace {

TriangleMesh berth_today(std::uint64_t seed) {
  TriangleMesh mesh = berth_mesh();
  append(mesh, parked_now(seed), Pose::Identity());
  return mesh;
}

Eigen::Matrix<float, 3, 4> as_affine(const Pose& T) { return T.matrix().topRows<3>().cast<float>(); }

}  // namespace

BerthWorld::BerthWorld(const std::vector<TriangleMesh>& hull_meshes_H, const ShapeChange& change,
                       const LoaderMotion& loader, const HullMotion& hull,
                       const std::optional<Passage>& crane, std::uint64_t seed)
    : boom_(boom_mesh()),
      berth_(berth_today(seed)),
      portal_(portal_mesh()),
      water_(water_mesh()),
      passage_(crane.value_or(Passage{})),
      change_(&change),
      loader_(&loader),
      hull_(&hull) {
  for (const TriangleMesh& mesh : hull_meshes_H) hulls_.emplace_back(mesh);
  if (crane) crane_.emplace(crane_mesh());
  for (const Mover& mover : movers(seed)) {
    movers_.emplace_back(mover.mesh);
    walks_.push_back(mover.walk);
  }
}

BerthWorld::Placement BerthWorld::placement(const Pose& mount, double t) const {
  const Joints joints = loader_->at(t);
  const Pose T_W_L = lidar_pose(loader_machine(), joints, mount);
  const Pose T_G_L = Eigen::Translation3d(-joints.d_x, 0.0, 0.0) * T_W_L;
  const Pose T_water_L = Eigen::Translation3d(0.0, 0.0, hull_->ebb(t)) * T_W_L;
  const double driven = passage_.from + run_distance(passage_.run, t);
  Placement L_from;
  L_from[kBoom] = as_affine(mount);
  L_from[kHull] = as_affine(hull_->T_W_H(t).inverse() * T_W_L);
  L_from[kBerth] = as_affine(T_W_L);
  L_from[kPortal] = as_affine(T_G_L);
  L_from[kWater] = as_affine(T_water_L);
  L_from[kCrane] = as_affine(Eigen::Translation3d(-driven, 0.0, 0.0) * T_W_L);
  for (std::size_t i = 0; i < walks_.size(); ++i)
    L_from[kFirstMover + i] = as_affine(walks_[i].T_W_own(t).inverse() * T_W_L);
  return L_from;
}

BerthWorld::Sweep BerthWorld::sweep(const Pose& mount, double begin, double end) const {
  return {begin, end, placement(mount, begin), placement(mount, end)};
}

BerthWorld::Affine BerthWorld::between(const Sweep& sweep, double t, std::size_t body) {
  const auto s = static_cast<float>((t - sweep.begin) / (sweep.end - sweep.begin));
  return (1.0F - s) * sweep.at_begin[body] + s * sweep.at_end[body];
}

std::pair<Point, Point> BerthWorld::ray_W(const Sweep& sweep, double t, const Point& origin_L,
                                          const Point& direction_L) {
  const Affine T_W_L = between(sweep, t, kBerth);
  return {T_W_L.leftCols<3>() * origin_L + T_W_L.col(3), T_W_L.leftCols<3>() * direction_L};
}

const RayScene* BerthWorld::scene(std::size_t body, std::size_t shape) const {
  switch (body) {
    case kBoom:
      return &boom_;
    case kHull:
      return &hulls_[shape];
    case kBerth:
      return &berth_;
    case kPortal:
      return &portal_;
    case kWater:
      return &water_;
    case kCrane:
      return crane_ ? &*crane_ : nullptr;
    default:
      return &movers_[body - kFirstMover];
  }
}

std::optional<RayHit> BerthWorld::cast(const Sweep& sweep, double t, const Point& origin_L,
                                       const Point& direction_L, float max_range) const {
  const std::size_t shape = change_->at(t);
  std::optional<RayHit> nearest;
  float reach = max_range;
  for (std::size_t body = 0; body < Sweep::kBodies; ++body) {
    const RayScene* surfaces = scene(body, shape);
    if (surfaces == nullptr) continue;
    const Affine T = between(sweep, t, body);
    const Point origin = T.leftCols<3>() * origin_L + T.col(3);
    const Point direction = T.leftCols<3>() * direction_L;
    const auto hit = surfaces->cast(origin, direction, reach);
    if (!hit) continue;
    if (body == kWater && displaced(sweep, t, shape, origin_L + hit->distance * direction_L)) continue;
    nearest = hit;
    reach = hit->distance;
  }
  return nearest;
}

bool BerthWorld::displaced(const Sweep& sweep, double t, std::size_t shape, const Point& p_L) const {
  const Affine T_H_L = between(sweep, t, kHull);
  constexpr float kBelowAnyKeel = 20.0F;  // m
  return hulls_[shape].blocked(T_H_L.leftCols<3>() * p_L + T_H_L.col(3), {0.0F, 0.0F, -1.0F}, kBelowAnyKeel);
}

}  // namespace hulltrack
