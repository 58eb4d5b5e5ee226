// Which socket address is the PLC at, without ever waiting for a name server?
//
// Literals (IPv4, IPv6) are known at once. A name is looked up on a detached thread of its own, because
// getaddrinfo() may block for many seconds; next() waits for it no longer than told.
// Failure: a Result with a plain line. Thread rule: one thread calls.
#pragma once

#include <sys/socket.h>

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "core/base/result.hpp"
#include "core/base/time.hpp"

namespace hulltrack {

struct SocketAddress {
  sockaddr_storage storage{};
  socklen_t length = 0;
};

class HostResolver {
 public:
  HostResolver(std::string host, std::uint16_t port);

  /// The address to try now. An error means: not known yet, or no such host (the next call looks again).
  [[nodiscard]] Result<SocketAddress> next(Nanoseconds limit);

  /// The address did not answer: the name's next one is due, after its last a new lookup.
  void failed();

 private:
  struct Lookup;

  std::string host_;
  std::uint16_t port_;
  bool literal_ = false;
  std::vector<SocketAddress> addresses_;
  std::size_t current_ = 0;
  std::shared_ptr<Lookup> lookup_;  // shared with its thread, which may outlive us
};

}  // namespace hulltrack
