#include "tests/support/frame_recording.hpp"

#include <random>

#include "core/kinematics/loader_kinematics.hpp"
#include "lidar_drivers/sim/velodyne_encoder.hpp"
#include "tests/support/bench_scene.hpp"

namespace hulltrack::bench {
namespace {

constexpr double kTurnsPerSecond = 5.0;
constexpr double kTravelStart = -10.5;  // m
constexpr double kTravelSpeed = 0.5;    // m/s
constexpr float kRangeNoise = 0.02F;    // 1-sigma, m
constexpr float kDust = 0.02F;          // share of the rays that meet dust near the chute
constexpr std::uint8_t kIntensity = 100;
const MeasurementTime kStart = measurement_time_from_ns(1'000'000'000'000);

Joints joints_at(Nanoseconds since_start) {
  return {kTravelStart + kTravelSpeed * to_seconds(since_start), 0.0, 0.0};
}

LidarConfig hanging_lidar() {
  LidarConfig lidar;
  lidar.model = "velodyne_hdl32e";
  lidar.mount = pose_from_xyz_rpy_deg({0.0, 6.0, 9.0}, {180.0, 105.0, 150.0});
  lidar.max_range = 100.0;
  return lidar;
}

/// Casts the LiDAR's rays with noise and dust; counts what they meet.
class Caster {
 public:
  Caster(const Pose& mount, const Pose& T_W_H, std::uint32_t seed)
      : mount_(mount), T_H_W_(T_W_H.inverse()), rng_(seed) {}

  sim::LaserReturn cast(const sim::LaserFiring& firing) {
    // Clutter moves with the hull here, which the clock does not notice.
    const Pose T_H_L = T_H_W_ * lidar_pose(MachineConfig{}, joints_at(firing.time), mount_);
    const Eigen::Vector3d origin = T_H_L * firing.origin;
    auto [range, on_hull] =
        target_.cast(origin.cast<float>(), (T_H_L.linear() * firing.direction).cast<float>());
    if (uniform_(rng_) < kDust) {
      range = std::min(range, 2.0F + 10.0F * uniform_(rng_));
      on_hull = false;
    }
    if (!(range < 100.0F)) {
      return {};
    }
    ++returns_;
    clutter_ += on_hull ? 0.0 : 1.0;
    return {static_cast<double>(range + kRangeNoise * normal_(rng_)), kIntensity};
  }
  [[nodiscard]] double clutter() const { return clutter_ / returns_; }

 private:
  Pose mount_;
  Pose T_H_W_;
  RayTarget target_;
  std::mt19937 rng_;
  std::normal_distribution<float> normal_;
  std::uniform_real_distribution<float> uniform_;
  double returns_ = 0.0;
  double clutter_ = 0.0;
};

}  // namespace

FrameRecording record_frames(int frames, std::uint32_t seed) {
  FrameRecording recording;
  recording.lidar = hanging_lidar();
  recording.framing.frame_rate_hz = kTurnsPerSecond;
  recording.T_W_H = start_pose(0.12, radians(0.15), seed);
  const auto sensor =
      sim::VelodyneEncoder::create(recording.lidar.model, {.rpm = 60.0 * kTurnsPerSecond}).value();
  Caster caster(recording.lidar.mount, recording.T_W_H, seed);
  const auto length = nanoseconds_from_ms(1e3 * frames / kTurnsPerSecond) + 2 * sensor.packet_interval();
  std::vector<sim::LaserFiring> firings;
  std::vector<sim::LaserReturn> returns;
  for (std::uint64_t packet = 0; sensor.first_firing(packet) < length; ++packet) {
    sensor.firings(packet, firings);
    returns.clear();
    for (const sim::LaserFiring& firing : firings) {
      returns.push_back(caster.cast(firing));
    }
    recording.datagrams.push_back({kStart + sensor.last_firing(packet), sensor.encode(packet, returns)});
  }
  recording.clutter = caster.clutter();
  constexpr Nanoseconds kPoll = std::chrono::milliseconds(20);
  for (Nanoseconds t = -kPoll; t <= length + kPoll; t += kPoll) {
    recording.joints.add({kStart + t, joints_at(t)});
  }
  return recording;
}

Config config_for(const FrameRecording& recording) {
  Config config;
  config.lidars = {recording.lidar};
  config.framing = recording.framing;
  return config;
}

}  // namespace hulltrack::bench
