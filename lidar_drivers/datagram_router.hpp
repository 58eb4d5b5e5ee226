// Which LiDAR sent a datagram? By destination port, its data or its information, then by source address.
//
// The same rule live and in replay. Addresses are checked when the router is made. Thread rule: immutable.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "core/base/result.hpp"
#include "lidar_drivers/datagram.hpp"
#include "lidar_drivers/lidar_config.hpp"

namespace hulltrack {

/// Dotted IPv4 to host byte order; an error names the text.
[[nodiscard]] Result<std::uint32_t> parse_ipv4(const std::string& text);
/// Host byte order to dotted IPv4.
[[nodiscard]] std::string format_ipv4(std::uint32_t ip);

class DatagramRouter {
 public:
  [[nodiscard]] static Result<DatagramRouter> create(std::span<const LidarConfig> lidars);

  /// Index into the configuration's list. A LiDAR with a source address goes before one that takes any.
  [[nodiscard]] std::optional<std::size_t> lidar_of(const Datagram& datagram) const;

 private:
  struct Rule {
    std::uint16_t port;
    std::uint16_t information_port;  // 0 = none
    std::optional<std::uint32_t> source;
  };
  std::vector<Rule> rules_;
};

}  // namespace hulltrack
