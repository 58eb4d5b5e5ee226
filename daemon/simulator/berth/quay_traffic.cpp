#include "daemon/simulator/berth/quay_traffic.hpp"

#include <cmath>

#include "daemon/simulator/berth/quay_ground.hpp"
#include "daemon/simulator/random.hpp"

namespace hulltrack {
namespace {

constexpr std::uint64_t kParkedStream = 800;
constexpr std::uint64_t kSurveyStream = 801;
constexpr std::uint64_t kMoverStream = 802;

// Lanes: y of their middles. The portal's sills stand on y = -3 and -13.5.
constexpr float kParkingLane = -10.4F;
constexpr float kDrivingLane = -6.8F;
constexpr float kYardLane = -25.0F;
constexpr float kFootway = -4.6F;
constexpr float kYardFootway = -14.5F;

constexpr float kSlot = 14.0F;  // of a parking lane, m
constexpr int kSlots = 9;
constexpr float kFirstSlot = -0.5F * kSlot * static_cast<float>(kSlots - 1);

/// Length along x.
TriangleMesh lorry() {
  TriangleMesh mesh;
  add_box(mesh, {-4.6F, -1.25F, 0.9F}, {2.6F, 1.25F, 3.6F}, Material::white_paint);
  add_box(mesh, {2.9F, -1.2F, 0.6F}, {4.8F, 1.2F, 3.0F}, Material::steel);
  for (const float x : {-3.8F, -2.6F, 3.6F})
    for (const float y : {-1.2F, 0.9F})
      add_cylinder(mesh, {x, y, 0.5F}, {x, y + 0.3F, 0.5F}, 0.5F, 12, Material::rubber);
  return mesh;
}

TriangleMesh person() {
  TriangleMesh mesh;
  add_cylinder(mesh, {0.0F, 0.0F, 0.0F}, {0.0F, 0.0F, 0.8F}, 0.16F, 8, Material::dark_steel);
  add_cylinder(mesh, {0.0F, 0.0F, 0.8F}, {0.0F, 0.0F, 1.5F}, 0.24F, 8, Material::rubber);
  add_cylinder(mesh, {0.0F, 0.0F, 1.5F}, {0.0F, 0.0F, 1.78F}, 0.12F, 8, Material::white_paint);
  return mesh;
}

TriangleMesh container() {
  TriangleMesh mesh;
  add_box(mesh, {-3.03F, -1.22F, 0.0F}, {3.03F, 1.22F, 2.59F}, Material::steel);
  return mesh;
}

TriangleMesh van() {
  TriangleMesh mesh;
  add_box(mesh, {-2.6F, -1.0F, 0.35F}, {1.6F, 1.0F, 2.3F}, Material::white_paint);
  add_box(mesh, {1.6F, -1.0F, 0.35F}, {2.7F, 1.0F, 1.2F}, Material::white_paint);
  return mesh;
}

/// Two pontoons of a hatch set down on timber.
TriangleMesh hatch_covers() {
  TriangleMesh mesh;
  add_box(mesh, {-5.0F, -2.2F, 0.15F}, {5.0F, 2.0F, 0.75F}, Material::steel);
  add_box(mesh, {-4.8F, -2.1F, 0.9F}, {5.1F, 2.1F, 1.5F}, Material::steel);
  return mesh;
}

TriangleMesh people() {
  TriangleMesh mesh;
  for (const auto& [x, y] : {std::pair{0.0, 0.0}, std::pair{0.9, 0.3}, std::pair{0.3, 1.0}}) {
    Pose T = Pose::Identity();
    T.translation() = Eigen::Vector3d(x, y, 0.0);
    append(mesh, person(), T);
  }
  return mesh;
}

TriangleMesh drawn_thing(RandomStream& random) {
  switch (random.bits() % 5) {
    case 0:
      return lorry();
    case 1:
      return container();
    case 2:
      return van();
    case 3:
      return hatch_covers();
    default:
      return people();
  }
}

/// On the ground at (x, y), turned by `heading`.
void set_down(TriangleMesh& mesh, const TriangleMesh& thing, double x, double y, double heading) {
  Pose T = Pose::Identity();
  T.translation() =
      Eigen::Vector3d(x, y, static_cast<double>(quay_top(static_cast<float>(x), static_cast<float>(y))));
  T.linear() = rotation_from_rpy({0.0, 0.0, heading});
  append(mesh, thing, T);
}

/// Things in a share of the slots of one lane.
void park(TriangleMesh& mesh, float lane, double share, RandomStream& random) {
  for (int slot = 0; slot < kSlots; ++slot) {
    const bool taken = random.uniform() < share;
    const TriangleMesh thing = drawn_thing(random);
    const double x =
        static_cast<double>(kFirstSlot + kSlot * static_cast<float>(slot)) + random.uniform(-1.5, 1.5);
    const double heading = radians(random.uniform(-3.0, 3.0));
    if (taken) set_down(mesh, thing, x, static_cast<double>(lane), heading);
  }
}

}  // namespace

TriangleMesh parked_now(std::uint64_t seed) {
  TriangleMesh mesh;
  RandomStream random(seed, kParkedStream);
  park(mesh, kParkingLane, 0.35, random);
  park(mesh, kYardLane, 0.35, random);
  return mesh;
}

TriangleMesh parked_at_survey(std::uint64_t seed) {
  TriangleMesh mesh;
  RandomStream random(seed, kSurveyStream);
  const double x = random.uniform(-30.0, 30.0);
  set_down(mesh, lorry(), x, static_cast<double>(kParkingLane), 0.0);
  return mesh;
}

Pose Walk::T_W_own(double t) const {
  const double way = std::fmod(start_ + speed_ * t, 2.0 * length_);
  const double x = from_ + (way < length_ ? way : 2.0 * length_ - way);
  Pose T = Pose::Identity();
  T.translation() =
      Eigen::Vector3d(x, y_, static_cast<double>(quay_top(static_cast<float>(x), static_cast<float>(y_))));
  return T;
}

std::array<Mover, kMovers> movers(std::uint64_t seed) {
  RandomStream random(seed, kMoverStream);
  const auto walk = [&](float lane, double half_way, double speed) {
    return Walk(static_cast<double>(lane), -half_way, half_way, speed, random.uniform(0.0, 4.0 * half_way));
  };
  return {Mover{lorry(), walk(kDrivingLane, 120.0, 4.0)}, Mover{person(), walk(kFootway, 50.0, 1.3)},
          Mover{person(), walk(kYardFootway, 50.0, 1.1)}};
}

}  // namespace hulltrack
