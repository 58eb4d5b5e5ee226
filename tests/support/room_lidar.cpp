#include "tests/support/room_lidar.hpp"

#include <chrono>
#include <cmath>
#include <stdexcept>
#include <vector>

#include "lidar_drivers/sim/velodyne_encoder.hpp"
#include "tests/support/free_port.hpp"

namespace hulltrack {
namespace {

const Eigen::Vector3d kLow(-16.0, -12.0, -8.0);
const Eigen::Vector3d kHigh(18.0, 11.0, 9.0);
constexpr double kMapStep = 0.1;  // m

/// One UDP socket whose source address can change.
class Sender {
 public:
  Sender(std::uint16_t port, std::uint32_t source_ip) : port_(port) { open(source_ip); }
  ~Sender() { close(fd_); }
  Sender(const Sender&) = delete;
  Sender& operator=(const Sender&) = delete;

  void send(std::span<const std::uint8_t> bytes, std::uint32_t source_ip) {
    if (source_ip != source_ip_) {
      close(fd_);
      open(source_ip);
    }
    sockaddr_in to = loopback_address(port_);
    // Nobody listening is no error of the sensor's.
    static_cast<void>(sendto(fd_, bytes.data(), bytes.size(), 0, as_sockaddr(&to), sizeof to));
  }

 private:
  void open(std::uint32_t source_ip) {
    source_ip_ = source_ip;
    fd_ = socket(AF_INET, SOCK_DGRAM | SOCK_CLOEXEC, 0);
    sockaddr_in from = loopback_address(0, source_ip);
    if (fd_ < 0 || bind(fd_, as_sockaddr(&from), sizeof from) != 0) {
      throw std::runtime_error("cannot open the sensor's socket");
    }
  }

  std::uint16_t port_;
  std::uint32_t source_ip_ = 0;
  int fd_ = -1;
};

}  // namespace

RoomLidar::RoomLidar(std::uint16_t port)
    : source_ip_(INADDR_LOOPBACK), thread_([this, port](const std::stop_token& stop) { run(stop, port); }) {}

Pose RoomLidar::mount() { return pose_from_xyz_rpy_deg({0.2, -0.3, 0.5}, {35.0, 20.0, 10.0}); }

double RoomLidar::range(const Eigen::Vector3d& p, const Eigen::Vector3d& direction) {
  double nearest = INFINITY;
  for (int axis = 0; axis < 3; ++axis) {
    if (direction[axis] != 0.0) {
      const double wall = direction[axis] > 0.0 ? kHigh[axis] : kLow[axis];
      nearest = std::min(nearest, (wall - p[axis]) / direction[axis]);
    }
  }
  return nearest;
}

Cloud RoomLidar::map() {
  Cloud cloud;
  for (int axis = 0; axis < 3; ++axis) {
    const int u = (axis + 1) % 3;
    const int v = (axis + 2) % 3;
    for (const double wall : {kLow[axis], kHigh[axis]}) {
      for (double a = kLow[u]; a < kHigh[u]; a += kMapStep) {
        for (double b = kLow[v]; b < kHigh[v]; b += kMapStep) {
          Eigen::Vector3d p;
          p[axis] = wall;
          p[u] = a;
          p[v] = b;
          cloud.push_back(p.cast<float>());
        }
      }
    }
  }
  return cloud;
}

void RoomLidar::run(const std::stop_token& stop, std::uint16_t port) {
  const auto made = sim::VelodyneEncoder::create(kModel, {});
  const sim::VelodyneEncoder& sensor = made.value();
  Sender sender(port, source_ip_);
  const Pose T_W_L = mount();
  std::vector<sim::LaserFiring> firings;
  std::vector<sim::LaserReturn> returns;
  const auto start = std::chrono::steady_clock::now();
  for (std::uint64_t packet = 0; !stop.stop_requested(); ++packet) {
    sensor.firings(packet, firings);
    returns.clear();
    for (const sim::LaserFiring& firing : firings) {
      const Eigen::Vector3d origin = T_W_L * firing.origin;
      returns.push_back({range(origin, T_W_L.linear() * firing.direction), 100});
    }
    const auto bytes = sensor.encode(packet, returns);
    std::this_thread::sleep_until(start + sensor.last_firing(packet));  // a sensor sends in real time
    if (!muted_) {
      sender.send(bytes, source_ip_);
    }
  }
}

}  // namespace hulltrack
