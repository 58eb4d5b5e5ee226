#include "daemon/simulator/run/udp_sender.hpp"

#include <arpa/inet.h>
#include <netinet/in.h>
#include <sys/socket.h>
#include <unistd.h>

#include <cerrno>
#include <system_error>
#include <utility>

namespace hulltrack {
namespace {

Error failure(const std::string& what) { return Error{what + ": " + std::generic_category().message(errno)}; }

}  // namespace

Result<UdpSender> UdpSender::create(const std::string& host, std::uint16_t port) {
  sockaddr_in address{};
  address.sin_family = AF_INET;
  address.sin_port = htons(port);
  if (inet_pton(AF_INET, host.c_str(), &address.sin_addr) != 1)
    return Error{"\"" + host + "\" is not an IPv4 address such as 127.0.0.1"};
  const int socket = ::socket(AF_INET, SOCK_DGRAM | SOCK_CLOEXEC, 0);
  if (socket < 0) return failure("cannot open a UDP socket");
  UdpSender sender(socket);
  if (::connect(socket, reinterpret_cast<const sockaddr*>(&address), sizeof address) != 0)
    return failure("cannot send to " + host);
  return sender;
}

UdpSender::~UdpSender() {
  if (socket_ >= 0) ::close(socket_);
}

UdpSender::UdpSender(UdpSender&& other) noexcept : socket_(std::exchange(other.socket_, -1)) {}

UdpSender& UdpSender::operator=(UdpSender&& other) noexcept {
  std::swap(socket_, other.socket_);
  return *this;
}

Result<void> UdpSender::send(std::span<const std::uint8_t> bytes) {
  if (::send(socket_, bytes.data(), bytes.size(), 0) >= 0) return {};
  // Refused: nobody listens (yet). Full: the host is busy; a datagram is lost.
  if (errno == ECONNREFUSED || errno == ENOBUFS || errno == EAGAIN || errno == EINTR) return {};
  return failure("cannot send to the LiDAR port");
}

}  // namespace hulltrack
