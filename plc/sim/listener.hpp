// A loopback port that stays ours while its listener comes and goes.
//
// A bound socket that never listens reserves the port, so that "connection refused" can be switched on
// and off without losing it to another process. Failure: the constructor throws std::runtime_error.
// Thread rule: external locking. Linux only: it relies on SO_REUSEADDR and on a full accept queue
// dropping SYNs.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace hulltrack::sim {

class Listener {
 public:
  /// Port 0 = any free one. Listens when it returns.
  Listener(const std::string& ipv4, std::uint16_t port);
  ~Listener();
  Listener(const Listener&) = delete;
  Listener& operator=(const Listener&) = delete;

  [[nodiscard]] std::uint16_t port() const { return port_; }
  /// To poll for connections; -1 unless open.
  [[nodiscard]] int accepting_fd() const { return black_hole_ ? -1 : fd_; }

  void open();
  /// Connections are refused.
  void refuse();
  /// The accept queue is full, so that the kernel ignores further SYNs.
  void black_hole();

 private:
  void close_listener();
  void listen_with(int backlog);

  std::string address_;
  std::uint16_t port_ = 0;
  int reservation_ = -1;
  int fd_ = -1;
  bool black_hole_ = false;
  std::vector<int> fillers_;  // our own connections that fill the accept queue
};

}  // namespace hulltrack::sim
