// Sends datagrams to one IPv4 address and port.
//
// Nobody needs to listen: a refused datagram is gone, as on a real network. Thread rule: one owner.
#pragma once

#include <cstdint>
#include <span>
#include <string>

#include "core/base/result.hpp"

namespace hulltrack {

class UdpSender {
 public:
  /// `host`: an IPv4 address in dotted form.
  [[nodiscard]] static Result<UdpSender> create(const std::string& host, std::uint16_t port);
  ~UdpSender();
  UdpSender(UdpSender&& other) noexcept;
  UdpSender& operator=(UdpSender&& other) noexcept;

  [[nodiscard]] Result<void> send(std::span<const std::uint8_t> bytes);

 private:
  explicit UdpSender(int socket) : socket_(socket) {}
  int socket_;
};

}  // namespace hulltrack
