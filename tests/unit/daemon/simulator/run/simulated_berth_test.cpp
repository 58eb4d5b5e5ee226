#include "daemon/simulator/run/simulated_berth.hpp"
#include "daemon/simulator/run/departures.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <vector>

#include "core/kinematics/joint_history.hpp"
#include "daemon/simulator/berth/loader_machine.hpp"
#include "daemon/simulator/berth/survey.hpp"
#include "daemon/simulator/run/simulated_scans.hpp"
#include "daemon/simulator/ship/ship_mesh.hpp"

namespace hulltrack {
namespace {

std::unique_ptr<SimulatedBerth> make(const SimulationOptions& options) {
  auto berth = SimulatedBerth::create(options);
  EXPECT_TRUE(berth.ok()) << (berth.ok() ? "" : berth.error().message);
  return std::move(berth).value();
}

/// Distance from p to a triangle, by clamping to its edges (Ericson, Real-Time Collision Detection, 5.1.5).
float distance_to_triangle(const Point& p, const Point& a, const Point& b, const Point& c) {
  const Point normal = (b - a).cross(c - a).normalized();
  const Point q = p - normal * normal.dot(p - a);
  const bool inside = (b - a).cross(q - a).dot(normal) >= 0.0F && (c - b).cross(q - b).dot(normal) >= 0.0F &&
                      (a - c).cross(q - c).dot(normal) >= 0.0F;
  if (inside) return std::abs(normal.dot(p - a));
  const auto to_edge = [&](const Point& u, const Point& v) {
    const float t = std::clamp((p - u).dot(v - u) / (v - u).squaredNorm(), 0.0F, 1.0F);
    return (p - u - t * (v - u)).norm();
  };
  return std::min({to_edge(a, b), to_edge(b, c), to_edge(c, a)});
}

float distance_to_mesh(const TriangleMesh& mesh, const Point& p) {
  float nearest = 1e9F;
  for (const auto& t : mesh.triangles) {
    const Point &a = mesh.vertices[t[0]], &b = mesh.vertices[t[1]], &c = mesh.vertices[t[2]];
    const Point low = a.cwiseMin(b).cwiseMin(c).array() - nearest;
    const Point high = a.cwiseMax(b).cwiseMax(c).array() + nearest;
    if ((p.array() < low.array()).any() || (p.array() > high.array()).any()) continue;
    nearest = std::min(nearest, distance_to_triangle(p, a, b, c));
  }
  return nearest;
}

TEST(SimulatedBerth, SameSeedSameBytesOtherSeedOtherBytes) {
  const auto one = make({.seed = 3, .frames = 5});
  const auto same = make({.seed = 3, .frames = 5});
  const auto other = make({.seed = 4, .frames = 5});
  // In another order: a datagram does not depend on which was asked for before.
  const auto packet = [](const auto& berth, std::uint64_t number) {
    return berth->lidars().front().packet(number);
  };
  EXPECT_EQ(packet(one, 200), packet(same, 200));
  EXPECT_EQ(packet(same, 17), packet(one, 17));
  EXPECT_NE(packet(one, 17), packet(other, 17));
  EXPECT_NE(packet(one, 17), packet(one, 18));
}

TEST(SimulatedBerth, UnknownNamesAreErrorsThatNameTheChoice) {
  const auto no_scenario = SimulatedBerth::create({.scenario = "typhoon"});
  ASSERT_FALSE(no_scenario.ok());
  EXPECT_NE(no_scenario.error().message.find("wrong-ship"), std::string::npos);
  const auto no_model = SimulatedBerth::create({.lidar_models = {"sundial"}});
  ASSERT_FALSE(no_model.ok());
  EXPECT_NE(no_model.error().message.find("velodyne_vlp32c"), std::string::npos);
}

struct HullShare {
  int on = 0;
  int off = 0;
};

/// How many returns of the last two frames lie on the ship when taken to H with the joints of their own
/// firing time and the hull pose of `delay` later? At the end of `berth` the ship moves at 0.5 m/s.
HullShare share_on_hull(const SimulatedBerth& berth, std::size_t of, Nanoseconds delay) {
  const TriangleMesh hull = berth.hull_mesh_H();
  const Box region = *berth.hull_config().region;
  const auto boxes = berth.lidar_config(of).exclude;
  std::vector<sim::LaserFiring> firings;
  HullShare share;
  const SimulatedLidar& lidar = berth.lidars()[of];
  for (std::uint64_t packet = lidar.packets() - 150; packet < lidar.packets(); packet += 3) {
    const auto returns = lidar.returns(packet);
    lidar.encoder().firings(packet, firings);
    for (std::size_t i = packet % 5; i < returns.size(); i += 5) {
      if (returns[i].range <= 0.0) continue;
      const Eigen::Vector3d p_L = firings[i].direction * returns[i].range + firings[i].origin;
      const Joints joints = berth.true_joints(firings[i].time);
      const Eigen::Vector3d p_W = lidar_pose(loader_machine(), joints, lidar.mount()) * p_L;
      const bool own = std::any_of(boxes.begin(), boxes.end(), [&](const auto& b) {
        return Box{{static_cast<float>(b[0]), static_cast<float>(b[1]), static_cast<float>(b[2])},
                   {static_cast<float>(b[3]), static_cast<float>(b[4]), static_cast<float>(b[5])}}
            .contains(p_L.cast<float>());
      });
      const bool on_water = p_W.z() < -4.5 && p_W.y() > 21.0;
      if (own || on_water || !region.contains(p_W.cast<float>())) continue;
      const Eigen::Vector3d p_H = berth.T_W_H(firings[i].time + delay).inverse() * p_W;
      (distance_to_mesh(hull, p_H.cast<float>()) < 0.07F ? share.on : share.off) += 1;
    }
  }
  return share;
}

/// The law of the whole simulator.
TEST(SimulatedBerth, EveryHullReturnLiesOnTheHullAtItsOwnFiringTime) {
  const auto berth =
      make({.scenario = "berth", .lidar_models = {"velodyne_vlp16", "velodyne_vlp32c"}, .seed = 11});
  for (std::size_t lidar = 0; lidar < 2; ++lidar) {
    const HullShare own_time = share_on_hull(*berth, lidar, Nanoseconds{0});
    EXPECT_GT(own_time.on, 400) << lidar;
    EXPECT_LT(own_time.off, 0.03 * own_time.on) << lidar << ": more than noise and mixed pixels explain";
    const HullShare half_a_second_late = share_on_hull(*berth, lidar, std::chrono::milliseconds(500));
    EXPECT_GT(half_a_second_late.off, 2 * own_time.off + 20) << lidar << ": the check sees nothing";
  }
}

TEST(SimulatedBerth, ASecondLidarChangesNothingOfTheFirst) {
  const auto one = make({.seed = 3, .frames = 2});
  const auto two = make({.lidar_models = {"velodyne_vlp16", "velodyne_vlp16"}, .seed = 3, .frames = 2});
  EXPECT_EQ(one->lidars()[0].packet(40), two->lidars()[0].packet(40));
  EXPECT_NE(two->lidars()[0].packet(40), two->lidars()[1].packet(40));
  EXPECT_FALSE(SimulatedBerth::create({.lidar_models = {}}).ok());
  EXPECT_FALSE(SimulatedBerth::create({.lidar_models = std::vector<std::string>(3, "velodyne_vlp16")}).ok());
}

TEST(SimulatedBerth, DatagramsLeaveInOrderOfTimeAndNoneOfAnUnpluggedLidar) {
  SimulationOptions options{.lidar_models = {"velodyne_vlp16", "robosense_helios32"}, .frames = 20};
  options.unplugged = Unplugged{.lidar = 1, .when = {.first = 0.5, .length = 1.0}};
  const auto berth = make(options);
  Departures departures(*berth);
  std::array<std::uint64_t, 2> packets{};
  int informations = 0;
  Nanoseconds before{0};
  while (const auto departure = departures.next()) {
    EXPECT_LE(before, departure->time);
    before = departure->time;
    const double t = to_seconds(departure->time);
    EXPECT_FALSE(departure->lidar == 1 && t >= 0.5 && t < 1.5) << t;
    departure->packet ? void(++packets[departure->lidar]) : void(++informations);
  }
  EXPECT_EQ(packets[0], berth->lidars()[0].packets());
  EXPECT_NEAR(static_cast<double>(packets[1]), 0.5 * static_cast<double>(berth->lidars()[1].packets()), 2.0);
  EXPECT_EQ(informations, 2) << "once a second, and again as soon as its cable is back";
  options.unplugged->lidar = 2;
  EXPECT_FALSE(SimulatedBerth::create(options).ok());
}

TEST(SimulatedBerth, RangeNoiseHasItsStatedSpread) {
  // Against the noise-free distance of the same ray.
  const auto berth = make({.scenario = "static", .seed = 2, .frames = 3});
  const SimulatedLidar& lidar = berth->lidars().front();
  std::vector<sim::LaserFiring> firings;
  double sum = 0.0;
  double squares = 0.0;
  int count = 0;
  for (std::uint64_t packet = 0; packet < 200; packet += 3) {
    const auto returns = lidar.returns(packet);
    lidar.encoder().firings(packet, firings);
    const auto sweep = berth->world().sweep(lidar.mount(), to_seconds(firings.front().time),
                                            to_seconds(firings.back().time));
    for (std::size_t i = 0; i < returns.size(); ++i) {
      const auto hit =
          berth->world().cast(sweep, to_seconds(firings[i].time), firings[i].origin.cast<float>(),
                              firings[i].direction.cast<float>(), 100.0F);
      if (!hit || returns[i].range <= 0.0 || hit->cos_incidence < 0.7F) continue;
      const double error = returns[i].range - static_cast<double>(hit->distance);
      if (std::abs(error) > 0.1) continue;  // an edge in the beam
      sum += error;
      squares += error * error;
      ++count;
    }
  }
  ASSERT_GT(count, 3000);
  EXPECT_NEAR(sum / count, 0.0, 0.003);
  EXPECT_NEAR(std::sqrt(squares / count), lidar.sensor().range_sigma, 0.004);
}

TEST(SimulatedBerth, MapLiesOnTheEmptyShipOnePointAVoxel) {
  const auto berth = make({.seed = 5, .frames = 1});
  const Cloud map = berth->map();
  EXPECT_GT(map.size(), 1'000'000U);
  EXPECT_LT(map.size(), 2'000'000U);
  const TriangleMesh ship = berth->map_mesh_H();
  std::vector<std::array<int, 3>> voxels;
  for (const Point& p : map) {
    const Eigen::Vector3i voxel = (p / 0.05F).array().floor().cast<int>();
    voxels.push_back({voxel.x(), voxel.y(), voxel.z()});
  }
  std::sort(voxels.begin(), voxels.end());
  EXPECT_EQ(std::adjacent_find(voxels.begin(), voxels.end()), voxels.end());
  for (std::size_t i = 0; i < map.size(); i += 4999) EXPECT_LT(distance_to_mesh(ship, map[i]), 0.03F);
}

TEST(Survey, SeesOnlyWhatIsNotBehindSomethingAndIsTheSameForASeed) {
  TriangleMesh mesh;
  add_box(mesh, {-2.0F, -2.0F, 0.0F}, {2.0F, 2.0F, 1.0F}, Material::steel);
  add_box(mesh, {-9.0F, -9.0F, -1.0F}, {9.0F, 9.0F, 0.0F}, Material::steel);
  const std::vector<Point> above = {{0.0F, 0.0F, 10.0F}};
  const Cloud map = survey(mesh, above, 8);
  EXPECT_GT(map.size(), 60'000U);
  for (const Point& p : map) {
    // The box hides the floor below it and casts a shadow of 2.2 m half width; its sides are in the shadow.
    const bool on_top = p.head<2>().cwiseAbs().maxCoeff() < 2.03F && std::abs(p.z() - 1.0F) < 0.03F;
    const bool on_floor = p.head<2>().cwiseAbs().maxCoeff() > 2.19F && std::abs(p.z()) < 0.03F;
    EXPECT_TRUE(on_top || on_floor) << p.transpose();
  }
  EXPECT_EQ(survey(mesh, above, 8), map);
  EXPECT_NE(survey(mesh, above, 9), map);
}

TEST(SimulatedBerth, AFullRunHasItsFramesAndJointsBracketEveryOne) {
  for (const char* model : {"velodyne_vlp16", "velodyne_vlp32c"}) {
    const auto berth = make({.lidar_models = {model}, .seed = 6, .frames = 7});
    const auto scans = simulated_scans(*berth, 0, 7);
    ASSERT_TRUE(scans.ok()) << scans.error().message;
    ASSERT_EQ(scans->size(), 7U) << model;
    JointHistory history;
    for (const JointSample& sample : simulated_joint_samples(*berth)) ASSERT_TRUE(history.add(sample));
    for (std::size_t i = 0; i < scans->size(); ++i) {
      const Scan& scan = (*scans)[i];
      EXPECT_EQ(scan.frame_number, i);
      EXPECT_EQ(scan.mid_time(), SimulatedBerth::kEpoch + SimulatedBerth::kFramePeriod * static_cast<int>(i) +
                                     SimulatedBerth::kFramePeriod / 2);
      EXPECT_GT(scan.points.size(), 10'000U);
      EXPECT_EQ(history.covers(scan.first_firing, scan.last_firing), JointHistory::Lookup::ok);
    }
  }
}

TEST(SimulatedBerth, AParkedLoaderPresentsConstants) {
  const auto berth = make({.frames = 10, .parked = Joints{3.0, radians(90.0), radians(1.0)}});
  const Joints first = berth->plc(Nanoseconds{0}).joints;
  EXPECT_NEAR(first.d_x, 3.0, 0.0005);
  const Joints later = berth->plc(std::chrono::seconds(1)).joints;
  EXPECT_EQ(first.theta_r, later.theta_r);
}

TEST(SimulatedBerth, TheShipLeavesWhenTold) {
  const auto early = make({.frames = 300, .leave_at = 10.0});
  const auto moored = make({.frames = 300});
  const auto apart = [&](int seconds) {
    const Nanoseconds t = std::chrono::seconds(seconds);
    return (early->truth(t).displacement - moored->truth(t).displacement).norm();
  };
  EXPECT_EQ(apart(10), 0.0);
  EXPECT_NEAR(apart(15), 0.5 * 0.08 * 25.0, 1e-9);  // hulltrack(1): 0.08 m/s2
  EXPECT_FALSE(SimulatedBerth::create({.scenario = "static", .leave_at = 10.0}).ok());
}

/// Height in W of the first surface straight below (x, y) at time t.
RayHit below(const SimulatedBerth& berth, double t, double x, double y) {
  constexpr double kFrom = 60.0;  // m, above everything
  const Pose& mount = berth.lidars().front().mount();
  const Joints joints = berth.true_joints(nanoseconds_from_ms(t * 1e3));
  const Pose T_L_W = lidar_pose(loader_machine(), joints, mount).inverse();
  const Eigen::Vector3d origin = T_L_W * Eigen::Vector3d(x, y, kFrom);
  const Eigen::Vector3d down = T_L_W.linear() * Eigen::Vector3d(0.0, 0.0, -1.0);
  auto hit = berth.world().cast(berth.world().sweep(mount, t, t + 0.001), t, origin.cast<float>(),
                                down.cast<float>(), 200.0F);
  EXPECT_TRUE(hit);
  hit->distance = static_cast<float>(kFrom) - hit->distance;
  return *hit;
}

TEST(SimulatedBerth, TheWaterFollowsTheEbbAndTheShipSinksByEbbAndCargo) {
  const auto berth = make({.scenario = "draft", .seed = 2});
  for (const double t : {0.0, 50.0, 100.0, 139.0}) {
    const RayHit water = below(*berth, t, 0.0, 60.0);
    EXPECT_EQ(water.material, Material::water);
    // 0.02 m/s after a ramp of 2 s, in which it falls by half as much.
    EXPECT_NEAR(static_cast<double>(water.distance), -5.0 - (t > 0.0 ? 0.02 * (t - 1.0) : 0.0), 1e-3) << t;
  }
  EXPECT_EQ(below(*berth, 0.0, 0.0, -30.0).material, below(*berth, 141.0, 0.0, -30.0).material);
  const double light = static_cast<double>(below(*berth, 0.0, 1.5, 12.0).distance);
  const double laden = static_cast<double>(below(*berth, 141.0, 1.5, 12.0).distance);
  EXPECT_NEAR(laden - light, -6.95, 0.25);  // cross deck; heave and pitch move it a little
}

TEST(SimulatedBerth, TheCraneDrivesPastAlongTheQuaysEdge) {
  const auto berth = make({.scenario = "crane", .seed = 2});
  const auto carrier_at = [&](double t, double x) { return below(*berth, t, x, -1.4).distance > 1.0F; };
  EXPECT_TRUE(carrier_at(0.0, -28.0));
  EXPECT_FALSE(carrier_at(0.0, 0.0));
  // 1 s of rest, 3 s to 1.8 m/s: 28 m after 1 + 1.5 + 28 / 1.8 s.
  EXPECT_TRUE(carrier_at(18.06, 0.0));
  EXPECT_FALSE(carrier_at(18.06, -28.0));
  const RayHit load = below(*berth, 18.06, 1.2, 5.7);  // beside the jib, over the deck's edge
  EXPECT_NEAR(load.distance, 4.6F, 0.01F);
}

TEST(ShipMesh, MovedCoversChangeNothingButTheCovers) {
  const RayScene mapped(ship_mesh(berth_ship()));
  const RayScene moved(ship_mesh(ship_with_moved_covers()));
  const auto height = [](const RayScene& ship, float x, float y) {
    const auto hit = ship.cast({x, y, 60.0F}, {0.0F, 0.0F, -1.0F}, 100.0F);
    return hit ? 60.0F - hit->distance : -100.0F;
  };
  for (float x = -59.0F; x < 59.0F; x += 0.31F)
    for (const float y : {-9.5F, -8.4F, -7.4F, 7.4F, 8.4F, 9.5F})
      EXPECT_EQ(height(mapped, x, y), height(moved, x, y)) << x << ' ' << y;
  // Closed: steel over the first and the last hatch, where the map looks into the hold.
  for (const std::size_t i : {0U, 3U}) {
    const Hatch hatch = berth_ship().hatches[i];
    EXPECT_LT(height(mapped, hatch.centre + 0.3F, 0.0F), 0.0F);
    EXPECT_GT(height(moved, hatch.centre + 0.3F, 0.0F), hatch.coaming_height + 0.5F);
  }
}

TEST(ShipMesh, CargoBeginsAsAThinLayerAndGrowsBelowTheDeck) {
  const ShipDesign ship = berth_ship();
  const auto top = [&](float fill) {
    float highest = -1e9F;
    for (const Point& p : cargo_mesh(ship, fill).vertices) highest = std::max(highest, p.z());
    return highest;
  };
  EXPECT_LT(top(0.005F), ship.tank_top + 0.2F);
  float before = ship.tank_top;
  for (float fill = 0.025F; fill < 0.96F; fill += 0.025F) {
    EXPECT_GT(top(fill), before) << fill;
    before = top(fill);
  }
  EXPECT_LT(before, 0.0F);
  EXPECT_GT(before, -2.5F);
}

}  // namespace
}  // namespace hulltrack
