#include "plc/tcp_connect.hpp"

#include <netinet/in.h>
#include <netinet/tcp.h>
#include <poll.h>
#include <sys/select.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <system_error>

namespace hulltrack {
namespace {

std::string words(int error) { return std::generic_category().message(error); }

/// 0, or the errno with which the connection attempt ended.
int wait_until_connected(int fd, Nanoseconds limit) {
  const auto deadline = std::chrono::steady_clock::now() + limit;
  pollfd waiting{.fd = fd, .events = POLLOUT, .revents = 0};
  for (;;) {
    const auto left =
        std::chrono::ceil<std::chrono::milliseconds>(deadline - std::chrono::steady_clock::now()).count();
    const int ready = poll(&waiting, 1, static_cast<int>(std::max<decltype(left)>(left, 0)));
    if (ready == 0) return ETIMEDOUT;
    if (ready > 0) break;
    if (errno != EINTR) return errno;
  }
  int error = 0;
  socklen_t size = sizeof error;
  if (getsockopt(fd, SOL_SOCKET, SO_ERROR, &error, &size) != 0) return errno;
  return error;
}

}  // namespace

Result<int> connect_within(const SocketAddress& address, Nanoseconds limit) {
  const int fd = socket(address.storage.ss_family, SOCK_STREAM | SOCK_NONBLOCK | SOCK_CLOEXEC, IPPROTO_TCP);
  if (fd < 0) return Error{words(errno)};
  if (fd >= FD_SETSIZE) {
    close(fd);
    return Error{"too many open files in this process: socket " + std::to_string(fd) + " is beyond select()"};
  }
  const int on = 1;
  setsockopt(fd, IPPROTO_TCP, TCP_NODELAY, &on, sizeof on);
  setsockopt(fd, SOL_SOCKET, SO_KEEPALIVE, &on, sizeof on);
  int error = 0;
  if (connect(fd, reinterpret_cast<const sockaddr*>(&address.storage), address.length) != 0) {
    error = errno == EINPROGRESS || errno == EINTR ? wait_until_connected(fd, limit) : errno;
  }
  if (error != 0) {
    close(fd);
    return Error{words(error)};
  }
  return fd;
}

}  // namespace hulltrack
