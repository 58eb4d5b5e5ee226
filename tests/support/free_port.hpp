// A port of the loopback interface that nobody uses at the moment.
#pragma once

#include <arpa/inet.h>
#include <netinet/in.h>
#include <sys/socket.h>
#include <unistd.h>

#include <cstdint>
#include <stdexcept>

namespace hulltrack {

inline sockaddr_in loopback_address(std::uint16_t port, std::uint32_t ip = INADDR_LOOPBACK) {
  sockaddr_in address{};
  address.sin_family = AF_INET;
  address.sin_addr.s_addr = htonl(ip);
  address.sin_port = htons(port);
  return address;
}

inline sockaddr* as_sockaddr(sockaddr_in* address) {
  return static_cast<sockaddr*>(static_cast<void*>(address));
}

/// `type`: SOCK_STREAM or SOCK_DGRAM.
inline std::uint16_t free_port(int type) {
  const int fd = socket(AF_INET, type | SOCK_CLOEXEC, 0);
  sockaddr_in address = loopback_address(0);
  socklen_t length = sizeof address;
  const bool bound = fd >= 0 && bind(fd, as_sockaddr(&address), length) == 0 &&
                     getsockname(fd, as_sockaddr(&address), &length) == 0;
  close(fd);
  if (!bound) {
    throw std::runtime_error("no free port on the loopback interface");
  }
  return ntohs(address.sin_port);
}

}  // namespace hulltrack
