#include "lidar_drivers/datagram_router.hpp"

#include <arpa/inet.h>

#include <algorithm>

namespace hulltrack {

Result<std::uint32_t> parse_ipv4(const std::string& text) {
  in_addr address{};
  if (inet_pton(AF_INET, text.c_str(), &address) != 1) {
    return Error{"\"" + text + "\" is no IPv4 address; write four numbers such as 192.168.1.201"};
  }
  return static_cast<std::uint32_t>(ntohl(address.s_addr));
}

std::string format_ipv4(std::uint32_t ip) {
  return std::to_string(ip >> 24) + "." + std::to_string(ip >> 16 & 0xFF) + "." +
         std::to_string(ip >> 8 & 0xFF) + "." + std::to_string(ip & 0xFF);
}

Result<DatagramRouter> DatagramRouter::create(std::span<const LidarConfig> lidars) {
  DatagramRouter router;
  for (const LidarConfig& lidar : lidars) {
    Rule rule{lidar.port, lidar.information_port, std::nullopt};
    if (!lidar.source.empty()) {
      const auto source = parse_ipv4(lidar.source);
      if (!source) return Error{"lidar \"" + lidar.name + "\", source: " + source.error().message};
      rule.source = *source;
    }
    router.rules_.push_back(rule);
  }
  return router;
}

std::optional<std::size_t> DatagramRouter::lidar_of(const Datagram& datagram) const {
  const auto find = [&](const std::optional<std::uint32_t>& source) -> std::optional<std::size_t> {
    const auto it = std::ranges::find_if(rules_, [&](const Rule& rule) {
      const std::uint16_t port = datagram.destination_port;
      return (rule.port == port || (rule.information_port != 0 && rule.information_port == port)) &&
             rule.source == source;
    });
    if (it == rules_.end()) return std::nullopt;
    return static_cast<std::size_t>(it - rules_.begin());
  };
  const auto exact = find(datagram.source_ip);
  return exact ? exact : find(std::nullopt);
}

}  // namespace hulltrack
