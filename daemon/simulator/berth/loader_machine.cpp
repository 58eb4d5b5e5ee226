#include "daemon/simulator/berth/loader_machine.hpp"

#include <algorithm>
#include <array>
#include <cmath>

namespace hulltrack {
namespace {

constexpr float kBoomTip = 21.5F;   // x in B
constexpr float kChuteX = 20.0F;    // x in B
constexpr float kChuteEnd = -9.0F;  // z in B
constexpr float kSpout = 0.6F;      // m below that
constexpr float kChuteRadius = 0.6F;
constexpr float kBoomHalfWidth = 0.9F;
constexpr float kBoomTop = 1.7F;
constexpr float kBoxMargin = 0.15F;  // for noise and mixed pixels on the machine's edges

/// Boxes in B that hold the boom and the chute, cut short so that they stay slim when turned into L.
std::vector<Box> machine_boxes_B() {
  std::vector<Box> boxes;
  constexpr float kBoomSlice = 3.2F;
  constexpr float kChuteSlice = 2.5F;
  for (float x = -7.0F; x < kBoomTip; x += kBoomSlice)
    boxes.push_back(
        {{x, -kBoomHalfWidth - 0.9F, -0.5F}, {x + kBoomSlice, kBoomHalfWidth + 0.1F, kBoomTop + 1.2F}});
  for (float z = kChuteEnd - 0.7F; z < 0.0F; z += kChuteSlice)
    boxes.push_back({{kChuteX - 1.0F, -1.0F, z}, {kChuteX + 1.0F, 1.0F, z + kChuteSlice}});
  return boxes;
}

}  // namespace

MachineConfig loader_machine() {
  MachineConfig machine;
  machine.slew.translation() = Eigen::Vector3d(0.0, -8.0, 17.0);
  machine.luff.translation() = Eigen::Vector3d(2.0, 0.0, 3.5);
  return machine;
}

LoaderLimits loader_limits() {
  return {.travel = {-28.0, 30.0, 0.4, 0.12, 1.0, 8.0},
          .slew = {radians(56.0), radians(124.0), radians(1.0), radians(0.35), radians(3.0), radians(25.0)},
          .luff = {radians(-5.0), radians(5.0), radians(0.28), radians(0.25), radians(0.6), radians(4.0)}};
}

LoaderLimits hurried_loader_limits() {
  LoaderLimits limits = loader_limits();
  limits.travel = {limits.travel.low, limits.travel.high, 0.5, 0.2, 6.0, 30.0};
  limits.slew = {limits.slew.low, limits.slew.high, radians(1.8), radians(0.6), radians(10.0), radians(60.0)};
  limits.shortest_pour = 0.2;
  limits.longest_pour = 1.5;
  limits.hurries = true;
  return limits;
}

LoaderLimits passing_loader_limits() {
  LoaderLimits limits = loader_limits();
  limits.travel = {-15.0, 15.0, 0.5, 0.2, 1.0, 30.0};
  limits.passes = true;
  return limits;
}

Point chute_end_B() { return {kChuteX, 0.0F, kChuteEnd - kSpout}; }

TriangleMesh boom_mesh() {
  TriangleMesh mesh;
  const auto beam = [&](const Point& min, const Point& max) {
    add_box(mesh, min, max, Material::white_paint);
  };
  for (const float y : {-kBoomHalfWidth, kBoomHalfWidth - 0.25F}) {
    beam({-7.0F, y, 0.0F}, {kBoomTip, y + 0.25F, 0.3F});
    beam({-7.0F, y, kBoomTop - 0.2F}, {kBoomTip, y + 0.25F, kBoomTop});
    for (float x = -6.0F; x < kBoomTip; x += 2.0F)
      add_cylinder(mesh, {x, y + 0.12F, 0.15F}, {x + 1.9F, y + 0.12F, kBoomTop - 0.1F}, 0.07F, 6,
                   Material::white_paint);
  }
  add_box(mesh, {-6.5F, -0.6F, 0.9F}, {kBoomTip, 0.6F, 1.0F}, Material::rubber);  // belt
  add_box(mesh, {-6.0F, -kBoomHalfWidth - 0.8F, 0.0F}, {kChuteX, -kBoomHalfWidth, 0.06F},
          Material::dark_steel);
  add_box(mesh, {-7.0F, -0.9F, -0.4F}, {-4.5F, 0.9F, 2.6F}, Material::concrete);  // counterweight
  add_cylinder(mesh, {kChuteX, 0.0F, 1.2F}, {kChuteX, 0.0F, kChuteEnd}, kChuteRadius, 20, Material::steel);
  add_box(mesh, {kChuteX - 0.8F, -0.8F, kChuteEnd - kSpout}, {kChuteX + 0.8F, 0.8F, kChuteEnd},
          Material::dark_steel);
  return mesh;
}

TriangleMesh portal_mesh() {
  TriangleMesh mesh;
  constexpr float kWaterRail = -3.0F;  // y in G
  constexpr float kLandRail = -13.5F;
  for (const float x : {-5.5F, 4.5F})
    for (const float y : {kWaterRail, kLandRail}) {
      add_box(mesh, {x, y - 0.5F, 1.0F}, {x + 1.0F, y + 0.5F, 9.0F}, Material::white_paint);
      add_box(mesh, {x - 1.2F, y - 0.4F, 0.0F}, {x + 2.2F, y + 0.4F, 1.0F}, Material::dark_steel);
    }
  add_box(mesh, {-5.8F, kLandRail - 0.6F, 8.6F}, {5.8F, kWaterRail + 0.6F, 10.0F}, Material::white_paint);
  add_cylinder(mesh, {0.0F, -8.0F, 10.0F}, {0.0F, -8.0F, 17.0F}, 1.8F, 24, Material::white_paint);
  add_box(mesh, {2.0F, -11.0F, 10.0F}, {4.5F, -8.5F, 12.6F}, Material::steel);  // electrical house
  return mesh;
}

std::span<const Pose> lidar_brackets() {
  // The spin axis is turned 30 deg out of the boom's direction and dips 15 deg, so that the fan crosses the
  // ship askew: decks, coaming sides and coaming ends are all in view, whichever way the boom is slewed. x of
  // L points down. Over the whole working range the smallest eigenvalue of a VLP-16's point-to-plane normal
  // matrix stays above 90 points' worth in translation (spin axis level and 60 deg out of the boom: 2);
  // hulltrack(1) has the figures. The other side is the mirror image: the two fans cross.
  static const std::array<Pose, 2> brackets = {
      pose_from_xyz_rpy_deg({18.4, 1.9, -1.6}, {0.0, 105.0, -30.0}),
      pose_from_xyz_rpy_deg({18.4, -1.9, -1.6}, {0.0, 105.0, 30.0}),
  };
  return brackets;
}

std::vector<Box> own_machine_boxes(const Pose& T_lidar) {
  const Eigen::Isometry3f T_L_B = T_lidar.inverse().cast<float>();
  std::vector<Box> boxes_L;
  for (const Box& box : machine_boxes_B()) {
    Box turned{Point::Constant(1e9F), Point::Constant(-1e9F)};
    for (int corner = 0; corner < 8; ++corner) {
      const Point p_B((corner & 1) != 0 ? box.max.x() : box.min.x(),
                      (corner & 2) != 0 ? box.max.y() : box.min.y(),
                      (corner & 4) != 0 ? box.max.z() : box.min.z());
      const Point p_L = T_L_B * p_B;
      turned.min = turned.min.cwiseMin(p_L);
      turned.max = turned.max.cwiseMax(p_L);
    }
    // Outward to the decimetre: what stands in a configuration should be readable.
    const auto decimetres = [](const Point& p) { return Point(p * 10.0F); };
    turned.min = decimetres(turned.min.array() - kBoxMargin).array().floor() / 10.0F;
    turned.max = decimetres(turned.max.array() + kBoxMargin).array().ceil() / 10.0F;
    boxes_L.push_back(turned);
  }
  return boxes_L;
}

}  // namespace hulltrack
