#include "plc/sim/listener.hpp"

#include <arpa/inet.h>
#include <netinet/in.h>
#include <sys/socket.h>
#include <unistd.h>

#include <cerrno>
#include <stdexcept>
#include <system_error>

namespace hulltrack::sim {
namespace {

constexpr int kBacklog = 16;

sockaddr_in socket_address(const std::string& ipv4, std::uint16_t port) {
  sockaddr_in address{};
  address.sin_family = AF_INET;
  address.sin_port = htons(port);
  if (inet_pton(AF_INET, ipv4.c_str(), &address.sin_addr) != 1) {
    throw std::runtime_error("not an IPv4 address to listen on: " + ipv4);
  }
  return address;
}

int bound_socket(const std::string& ipv4, std::uint16_t port) {
  const sockaddr_in address = socket_address(ipv4, port);
  const int fd = socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC | SOCK_NONBLOCK, IPPROTO_TCP);
  const int on = 1;
  if (fd < 0 || setsockopt(fd, SOL_SOCKET, SO_REUSEADDR, &on, sizeof on) != 0 ||
      bind(fd, reinterpret_cast<const sockaddr*>(&address), sizeof address) != 0) {
    const std::string why = std::generic_category().message(errno);
    if (fd >= 0) close(fd);
    throw std::runtime_error("cannot listen on " + ipv4 + " port " + std::to_string(port) + ": " + why);
  }
  return fd;
}

}  // namespace

Listener::Listener(const std::string& ipv4, std::uint16_t port)
    : address_(ipv4), reservation_(bound_socket(ipv4, port)) {
  sockaddr_in bound{};
  socklen_t size = sizeof bound;
  getsockname(reservation_, reinterpret_cast<sockaddr*>(&bound), &size);
  port_ = ntohs(bound.sin_port);
  try {
    open();
  } catch (...) {
    close(reservation_);
    throw;
  }
}

Listener::~Listener() {
  close_listener();
  close(reservation_);
}

void Listener::close_listener() {
  for (const int filler : fillers_) close(filler);
  fillers_.clear();
  if (fd_ >= 0) {
    shutdown(fd_, SHUT_RDWR);  // a poll() on it in another thread would keep it listening
    close(fd_);
  }
  fd_ = -1;
  black_hole_ = false;
}

void Listener::listen_with(int backlog) {
  fd_ = bound_socket(address_, port_);
  if (listen(fd_, backlog) != 0) {
    const std::string why = std::generic_category().message(errno);
    close_listener();
    throw std::runtime_error("cannot listen on " + address_ + " port " + std::to_string(port_) + ": " + why);
  }
}

void Listener::open() {
  close_listener();
  listen_with(kBacklog);
}

void Listener::refuse() { close_listener(); }

void Listener::black_hole() {
  close_listener();
  listen_with(0);
  black_hole_ = true;
  // With a backlog of 0 the queue holds one connection; the second filler finds it full already.
  const sockaddr_in address = socket_address(address_ == "0.0.0.0" ? "127.0.0.1" : address_, port_);
  for (int i = 0; i < 2; ++i) {
    const int filler = socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC | SOCK_NONBLOCK, IPPROTO_TCP);
    connect(filler, reinterpret_cast<const sockaddr*>(&address), sizeof address);
    fillers_.push_back(filler);
  }
}

}  // namespace hulltrack::sim
