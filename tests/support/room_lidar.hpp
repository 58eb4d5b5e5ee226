// A VLP-16 that hangs askew in an empty room and sends real packets over loopback in real time.
//
// The room plays the hull: its six walls fix all six degrees of freedom, every range is known in closed
// form, and its map is a grid of points. W, H and B coincide while the joints are 0.
// Thread rule: one thread of its own sends; every member may be called from any thread.
#pragma once

#include <atomic>
#include <cstdint>
#include <thread>

#include "core/geometry/cloud.hpp"
#include "core/geometry/se3.hpp"

namespace hulltrack {

class RoomLidar {
 public:
  static constexpr const char* kModel = "velodyne_vlp16";

  /// Starts to send to 127.0.0.1:port.
  explicit RoomLidar(std::uint16_t port);

  /// T_lidar of the configuration.
  [[nodiscard]] static Pose mount();
  /// The six walls, a point every 10 cm, in H.
  [[nodiscard]] static Cloud map();
  /// Distance from `p` inside the room along the unit vector `direction` to the wall, m.
  [[nodiscard]] static double range(const Eigen::Vector3d& p, const Eigen::Vector3d& direction);

  /// While muted the sensor turns on, but nothing is sent.
  void mute(bool muted) { muted_ = muted; }
  /// Packets sent from now on come from this address of the loopback network.
  void send_from(std::uint32_t ip) { source_ip_ = ip; }

 private:
  void run(const std::stop_token& stop, std::uint16_t port);

  std::atomic<bool> muted_ = false;
  std::atomic<std::uint32_t> source_ip_;
  std::jthread thread_;
};

}  // namespace hulltrack
