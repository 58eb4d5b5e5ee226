#include "plc/sim/connections.hpp"

#include <netinet/in.h>
#include <netinet/tcp.h>
#include <sys/socket.h>
#include <unistd.h>

#include <algorithm>
#include <utility>

namespace hulltrack::sim {

Connections::~Connections() {
  for (const Client& client : clients_) close(client.fd);
}

void Connections::set_door(Door door) {
  if (door == door_) return;
  door_ = door;
  ++generation_;
  switch (door) {
    case Door::open:
      return listener_.open();
    case Door::refused:
      return listener_.refuse();
    case Door::black_hole:
      return listener_.black_hole();
  }
}

void Connections::add_to(std::vector<pollfd>& waiting) const {
  waiting.push_back({.fd = listener_.accepting_fd(), .events = POLLIN, .revents = 0});
  if (door_ == Door::black_hole) return;
  for (const Client& client : clients_) waiting.push_back({.fd = client.fd, .events = POLLIN, .revents = 0});
}

int Connections::accept_descriptor() {
  const int fd = accept4(listener_.accepting_fd(), nullptr, nullptr, SOCK_CLOEXEC);
  accepted_ += fd >= 0 ? 1 : 0;
  return fd;
}

void Connections::accept() {
  const int fd = accept_descriptor();
  if (fd < 0) return;
  const int on = 1;
  setsockopt(fd, IPPROTO_TCP, TCP_NODELAY, &on, sizeof on);
  clients_.push_back({.fd = fd, .held_back = {}});
  most_open_ = std::max(most_open_, clients_.size());
  ++generation_;
}

void Connections::accept_and_close() {
  if (const int fd = accept_descriptor(); fd >= 0) close(fd);
}

void Connections::drop(int fd) {
  close(fd);
  std::erase_if(clients_, [fd](const Client& client) { return client.fd == fd; });
  std::erase_if(outgoing_, [fd](const Outgoing& item) { return item.fd == fd; });
  ++generation_;
}

void Connections::reset(int fd) {
  const linger at_once{.l_onoff = 1, .l_linger = 0};
  setsockopt(fd, SOL_SOCKET, SO_LINGER, &at_once, sizeof at_once);
  drop(fd);
}

void Connections::reset_all() {
  while (!clients_.empty()) reset(clients_.back().fd);
}

void Connections::send(int fd, const Bytes& bytes) {
  [[maybe_unused]] const ssize_t sent = ::send(fd, bytes.data(), bytes.size(), MSG_NOSIGNAL);
}

void Connections::send_at(SteadyTime due, int fd, Bytes bytes) {
  outgoing_.push_back({due, fd, std::move(bytes)});
}

void Connections::hold_back(int fd, Bytes bytes) {
  std::ranges::find(clients_, fd, &Client::fd)->held_back = std::move(bytes);
}

void Connections::release(int fd) {
  send(fd, std::exchange(std::ranges::find(clients_, fd, &Client::fd)->held_back, {}));
}

void Connections::send_due(SteadyTime now) {
  for (const Outgoing& item : outgoing_) {
    if (item.due <= now) send(item.fd, item.bytes);
  }
  std::erase_if(outgoing_, [now](const Outgoing& item) { return item.due <= now; });
}

int Connections::milliseconds_to_next_due(SteadyTime now) const {
  if (outgoing_.empty()) return -1;
  const SteadyTime next = std::ranges::min(outgoing_, {}, &Outgoing::due).due;
  const auto left = std::chrono::ceil<std::chrono::milliseconds>(next - now).count();
  return static_cast<int>(std::max<decltype(left)>(left, 0));
}

}  // namespace hulltrack::sim
