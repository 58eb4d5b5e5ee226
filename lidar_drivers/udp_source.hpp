// Live datagrams of one UDP port, each with its kernel receive stamp.
//
// Non-blocking: wait on fd() with epoll or poll, then call receive() until it returns nothing. Datagrams
// from other senders than the LiDARs' are dropped here and counted. The kernel's stamp is converted to
// the monotonic clock at once (receive_clock.hpp), so steps of the wall clock do not matter. The kernel
// counts (SO_RXQ_OVFL) what found no room and what a filter dropped as one; only a queue that was full had no
// room. LiDARs that share a port share one source. Thread rule: one owner.
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "core/base/result.hpp"
#include "lidar_drivers/datagram.hpp"
#include "lidar_drivers/lidar_config.hpp"

namespace hulltrack {

struct UdpCounters {
  std::uint64_t received = 0;          // datagrams handed out
  std::uint64_t foreign = 0;           // from an address that is no LiDAR's: dropped
  std::uint64_t kernel_overflows = 0;  // lost because the receive buffer was full
  std::uint64_t filtered = 0;          // kept from this socket by a packet filter: IPAddressDeny= of a unit
  std::uint64_t unstamped = 0;         // no kernel stamp: the time of reading was used
};

class UdpSource {
 public:
  /// One source for all `lidars`, which share bind address and port (see open_udp_sources). Joins their
  /// multicast groups. Errors say which address and port, and what to do (port in use, address not here).
  [[nodiscard]] static Result<UdpSource> open(std::span<const LidarConfig> lidars);

  UdpSource(UdpSource&& other) noexcept;
  UdpSource& operator=(UdpSource&& other) noexcept;
  ~UdpSource();

  [[nodiscard]] int fd() const { return fd_.get(); }
  /// The bound port: what the configuration says, or what the kernel chose for 0.
  [[nodiscard]] std::uint16_t port() const { return port_; }

  /// Up to 64 datagrams, without waiting; empty when none is there. Valid until the next call. An error
  /// means the socket is unusable.
  [[nodiscard]] Result<std::span<const Datagram>> receive();

  [[nodiscard]] const UdpCounters& counters() const { return counters_; }
  /// "10.0.0.7:5000", the sender dropped most recently; empty when there was none.
  [[nodiscard]] std::string last_foreign() const;
  /// What is not as it should be although it works, such as a receive buffer smaller than asked for.
  [[nodiscard]] const std::vector<std::string>& warnings() const { return warnings_; }

 private:
  struct Buffers;

  /// Closes what it holds.
  class Descriptor {
   public:
    explicit Descriptor(int fd) : fd_(fd) {}
    Descriptor(Descriptor&& other) noexcept : fd_(std::exchange(other.fd_, -1)) {}
    Descriptor& operator=(Descriptor&& other) noexcept {
      std::swap(fd_, other.fd_);
      return *this;
    }
    ~Descriptor();
    [[nodiscard]] int get() const { return fd_; }

   private:
    int fd_;
  };

  explicit UdpSource(int fd);
  void enlarge_receive_buffer();
  [[nodiscard]] bool is_queue_long() const;
  void count_dropped(std::uint32_t since_opened);
  [[nodiscard]] Result<void> bind_to(const LidarConfig& lidar, bool multicast);
  [[nodiscard]] Result<void> join_group(const LidarConfig& lidar);
  [[nodiscard]] bool accepts(std::uint32_t ip) const;

  Descriptor fd_;
  std::uint16_t port_ = 0;
  std::vector<std::uint32_t> allowed_;  // host byte order; empty = any
  UdpCounters counters_;
  std::uint32_t last_dropped_ = 0;
  bool queue_was_long_ = false;     // and may have lost something that was not counted yet
  bool queue_was_emptied_ = false;  // by the last call
  std::uint32_t foreign_ip_ = 0;
  std::uint16_t foreign_port_ = 0;
  std::vector<std::string> warnings_;
  std::unique_ptr<Buffers> buffers_;
};

struct UdpSources {
  std::vector<UdpSource> sources;    // one for each distinct pair of bind address and port
  std::vector<std::size_t> data_of;  // LiDAR -> index of the source of its data
};

/// All that the LiDARs of a configuration send, data and information.
[[nodiscard]] Result<UdpSources> open_udp_sources(std::span<const LidarConfig> lidars);

}  // namespace hulltrack
