#include "lidar_drivers/udp_source.hpp"

#include <arpa/inet.h>
#include <linux/sock_diag.h>
#include <netinet/in.h>
#include <sys/socket.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstring>
#include <ctime>
#include <optional>
#include <system_error>
#include <utility>

#include "lidar_drivers/datagram_router.hpp"
#include "lidar_drivers/receive_clock.hpp"

namespace hulltrack {

namespace {

constexpr std::size_t kBatch = 64;
constexpr std::size_t kDatagramBytes = 65'536;  // UDP carries less, so none is cut off
constexpr std::size_t kControlBytes = 128;
/// Some 0.3 s of the fastest sensors, two seconds of a VLP-16.
constexpr int kReceiveBufferBytes = 8 * 1024 * 1024;

std::string reason(int error) { return std::generic_category().message(error); }

/// How a message about `lidar` begins.
std::string name_of(const LidarConfig& lidar) {
  return (lidar.place.empty() ? "" : lidar.place + ": ") + "lidar \"" + lidar.name + "\"";
}

template <typename T>
void set_option(int fd, int level, int option, const T& value) {
  // An option that the kernel lacks shows in the counters (unstamped) or warnings, not here.
  static_cast<void>(setsockopt(fd, level, option, &value, sizeof value));
}

Nanoseconds read_clock(clockid_t clock) {
  timespec now{};
  clock_gettime(clock, &now);
  return std::chrono::seconds(now.tv_sec) + Nanoseconds(now.tv_nsec);
}

/// What the kernel says beside a datagram.
struct Control {
  std::optional<WallTime> stamp;
  std::optional<std::uint32_t> dropped;  // since the socket was made
};

Control read_control(msghdr& message) {
  Control control;
  for (cmsghdr* c = CMSG_FIRSTHDR(&message); c != nullptr; c = CMSG_NXTHDR(&message, c)) {
    if (c->cmsg_level != SOL_SOCKET) continue;
    if (c->cmsg_type == SCM_TIMESTAMPNS && c->cmsg_len >= CMSG_LEN(sizeof(timespec))) {
      timespec stamp{};
      std::memcpy(&stamp, CMSG_DATA(c), sizeof stamp);
      control.stamp = WallTime(std::chrono::seconds(stamp.tv_sec) + Nanoseconds(stamp.tv_nsec));
    } else if (c->cmsg_type == SO_RXQ_OVFL && c->cmsg_len >= CMSG_LEN(sizeof(std::uint32_t))) {
      std::uint32_t count = 0;
      std::memcpy(&count, CMSG_DATA(c), sizeof count);
      control.dropped = count;
    }
  }
  return control;
}

}  // namespace

/// What recvmmsg fills, and the datagrams that point into it.
struct UdpSource::Buffers {
  std::vector<std::uint8_t> bytes = std::vector<std::uint8_t>(kBatch * kDatagramBytes);
  std::array<std::array<std::uint8_t, kControlBytes>, kBatch> control{};
  std::array<sockaddr_in, kBatch> senders{};
  std::array<iovec, kBatch> parts{};
  std::array<mmsghdr, kBatch> messages{};
  std::vector<Datagram> datagrams;

  void prepare() {
    for (std::size_t i = 0; i < kBatch; ++i) {
      parts[i] = {bytes.data() + i * kDatagramBytes, kDatagramBytes};
      msghdr& header = messages[i].msg_hdr;
      header = {};
      header.msg_name = &senders[i];
      header.msg_namelen = sizeof senders[i];
      header.msg_iov = &parts[i];
      header.msg_iovlen = 1;
      header.msg_control = control[i].data();
      header.msg_controllen = kControlBytes;
    }
    datagrams.clear();
  }
};

Result<UdpSource> UdpSource::open(std::span<const LidarConfig> lidars) {
  if (lidars.empty()) return Error{"no LiDAR to listen to"};
  const int fd = socket(AF_INET, SOCK_DGRAM | SOCK_NONBLOCK | SOCK_CLOEXEC, 0);
  if (fd < 0) return Error{"no UDP socket: " + reason(errno)};
  UdpSource source(fd);
  set_option(fd, SOL_SOCKET, SO_TIMESTAMPNS, 1);
  set_option(fd, SOL_SOCKET, SO_RXQ_OVFL, 1);
  set_option(fd, IPPROTO_IP, IP_MULTICAST_ALL, 0);
  source.enlarge_receive_buffer();

  const bool multicast =
      std::ranges::any_of(lidars, [](const LidarConfig& l) { return !l.multicast.empty(); });
  if (auto bound = source.bind_to(lidars.front(), multicast); !bound) return bound.error();
  const bool any = std::ranges::any_of(lidars, [](const LidarConfig& l) { return l.source.empty(); });
  for (const LidarConfig& lidar : lidars) {
    if (!lidar.multicast.empty()) {
      if (auto joined = source.join_group(lidar); !joined) return joined.error();
    }
    if (any) continue;
    const auto address = parse_ipv4(lidar.source);
    if (!address) return Error{name_of(lidar) + ", source: " + address.error().message};
    source.allowed_.push_back(*address);
  }
  return source;
}

UdpSource::UdpSource(int fd) : fd_(fd), buffers_(std::make_unique<Buffers>()) {}

UdpSource::UdpSource(UdpSource&&) noexcept = default;
UdpSource& UdpSource::operator=(UdpSource&&) noexcept = default;
UdpSource::~UdpSource() = default;

UdpSource::Descriptor::~Descriptor() {
  if (fd_ >= 0) ::close(fd_);
}

void UdpSource::enlarge_receive_buffer() {
  set_option(fd(), SOL_SOCKET, SO_RCVBUF, kReceiveBufferBytes);
  set_option(fd(), SOL_SOCKET, SO_RCVBUFFORCE, kReceiveBufferBytes);  // beyond rmem_max, where permitted
  int got = 0;
  socklen_t length = sizeof got;
  getsockopt(fd(), SOL_SOCKET, SO_RCVBUF, &got, &length);
  got /= 2;  // the kernel doubles the figure for its own bookkeeping
  if (got >= kReceiveBufferBytes) return;
  warnings_.push_back("UDP receive buffer is " + std::to_string(got / 1024) + " KiB instead of " +
                      std::to_string(kReceiveBufferBytes / 1024) +
                      " KiB: packets may be lost when the host is busy; set net.core.rmem_max=" +
                      std::to_string(kReceiveBufferBytes) +
                      " with sysctl, or give the service CAP_NET_ADMIN");
}

Result<void> UdpSource::bind_to(const LidarConfig& lidar, bool multicast) {
  const std::string where = name_of(lidar) + ": ";
  const auto address = parse_ipv4(lidar.bind);
  if (!address) return Error{where + "bind: " + address.error().message};
  sockaddr_in local{};
  local.sin_family = AF_INET;
  local.sin_port = htons(lidar.port);
  local.sin_addr.s_addr =
      htonl(multicast ? INADDR_ANY : *address);  // a group does not arrive at a bound address
  if (bind(fd(), reinterpret_cast<const sockaddr*>(&local), sizeof local) != 0) {
    const int error = errno;
    const std::string port = std::to_string(lidar.port);
    if (error == EADDRINUSE) {
      return Error{where + "UDP port " + port + " on " + lidar.bind +
                   " is in use by another program; `ss -ulpn 'sport = :" + port +
                   "'` names it: stop it or configure another port"};
    }
    if (error == EADDRNOTAVAIL) {
      return Error{where + "bind: " + lidar.bind +
                   " is no address of this host; `ip address` lists them, 0.0.0.0 means all"};
    }
    return Error{where + "cannot listen on UDP " + lidar.bind + ":" + port + ": " + reason(error)};
  }
  socklen_t length = sizeof local;
  getsockname(fd(), reinterpret_cast<sockaddr*>(&local), &length);
  port_ = ntohs(local.sin_port);
  return {};
}

Result<void> UdpSource::join_group(const LidarConfig& lidar) {
  const std::string where = name_of(lidar) + ", multicast: ";
  const auto group = parse_ipv4(lidar.multicast);
  if (!group) return Error{where + group.error().message};
  if (!IN_MULTICAST(*group)) {
    return Error{where + lidar.multicast + " is no group; allowed are 224.0.0.0 to 239.255.255.255"};
  }
  const auto interface = parse_ipv4(lidar.bind);
  if (!interface) return Error{name_of(lidar) + ", bind: " + interface.error().message};
  ip_mreq request{};
  request.imr_multiaddr.s_addr = htonl(*group);
  request.imr_interface.s_addr = htonl(*interface);
  if (setsockopt(fd(), IPPROTO_IP, IP_ADD_MEMBERSHIP, &request, sizeof request) != 0) {
    return Error{where + "cannot join " + lidar.multicast + " on the interface of " + lidar.bind + ": " +
                 reason(errno) + "; set bind to this host's address on the LiDAR's network"};
  }
  return {};
}

bool UdpSource::accepts(std::uint32_t ip) const {
  return allowed_.empty() || std::ranges::find(allowed_, ip) != allowed_.end();
}

/// Only we take from the queue, so one that was full since the last call still is. Half of the buffer, since
/// the kernel accounts for what was taken in blocks of a quarter. Where it does not tell: long.
bool UdpSource::is_queue_long() const {
  std::array<std::uint32_t, SK_MEMINFO_VARS> memory{};
  socklen_t length = sizeof memory;
  if (getsockopt(fd(), SOL_SOCKET, SO_MEMINFO, memory.data(), &length) != 0) return true;
  return memory[SK_MEMINFO_RMEM_ALLOC] >= memory[SK_MEMINFO_RCVBUF] / 2;
}

/// The count comes with the first datagram that found room again: one from behind an emptied queue with
/// nothing new to tell says that the long queue before it lost nothing.
void UdpSource::count_dropped(std::uint32_t since_opened) {
  const std::uint32_t news = since_opened - last_dropped_;
  (queue_was_long_ ? counters_.kernel_overflows : counters_.filtered) += news;
  last_dropped_ = since_opened;
  if (news > 0 || queue_was_emptied_) {
    queue_was_long_ = false;
  }
  queue_was_emptied_ = false;
}

Result<std::span<const Datagram>> UdpSource::receive() {
  buffers_->prepare();
  const bool is_long = is_queue_long();
  int count = -1;
  do {
    count = recvmmsg(fd(), buffers_->messages.data(), kBatch, MSG_DONTWAIT, nullptr);
  } while (count < 0 && errno == EINTR);
  if (count < 0) {
    if (errno == EAGAIN || errno == EWOULDBLOCK) {
      queue_was_emptied_ = true;
      return std::span<const Datagram>{};
    }
    return Error{"UDP port " + std::to_string(port_) + " cannot be read: " + reason(errno)};
  }
  const WallTime realtime_now{read_clock(CLOCK_REALTIME)};
  const SteadyTime monotonic_now{read_clock(CLOCK_MONOTONIC)};

  for (std::size_t i = 0; i < static_cast<std::size_t>(count); ++i) {
    msghdr& header = buffers_->messages[i].msg_hdr;
    const Control control = read_control(header);
    count_dropped(control.dropped.value_or(last_dropped_));
    queue_was_long_ =
        queue_was_long_ || is_long;  // for those after the first: it waited before the queue was long
    const std::uint32_t sender = ntohl(buffers_->senders[i].sin_addr.s_addr);
    const std::uint16_t sender_port = ntohs(buffers_->senders[i].sin_port);
    if (!accepts(sender)) {
      ++counters_.foreign;
      foreign_ip_ = sender;
      foreign_port_ = sender_port;
      continue;
    }
    if (!control.stamp) ++counters_.unstamped;
    const WallTime stamp = control.stamp.value_or(realtime_now);
    ++counters_.received;
    buffers_->datagrams.push_back(
        {{buffers_->bytes.data() + i * kDatagramBytes, buffers_->messages[i].msg_len},
         receive_time(stamp, realtime_now, monotonic_now),
         stamp,
         sender,
         sender_port,
         port_});
  }
  return std::span<const Datagram>(buffers_->datagrams);
}

std::string UdpSource::last_foreign() const {
  return counters_.foreign == 0 ? "" : format_ipv4(foreign_ip_) + ":" + std::to_string(foreign_port_);
}

Result<UdpSources> open_udp_sources(std::span<const LidarConfig> lidars) {
  std::vector<LidarConfig> listening(lidars.begin(), lidars.end());
  for (const LidarConfig& lidar : lidars) {
    if (lidar.information_port != 0 && lidar.information_port != lidar.port) {
      listening.push_back(lidar);
      listening.back().port = lidar.information_port;
    }
  }
  UdpSources opened;
  std::vector<std::vector<LidarConfig>> groups;
  for (std::size_t i = 0; i < listening.size(); ++i) {
    const LidarConfig& lidar = listening[i];
    const auto same = std::ranges::find_if(groups, [&](const std::vector<LidarConfig>& group) {
      return group.front().bind == lidar.bind && group.front().port == lidar.port;
    });
    if (i < lidars.size()) opened.data_of.push_back(static_cast<std::size_t>(same - groups.begin()));
    if (same == groups.end()) {
      groups.push_back({lidar});
    } else {
      same->push_back(lidar);
    }
  }
  for (const auto& group : groups) {
    auto source = UdpSource::open(group);
    if (!source) return source.error();
    opened.sources.push_back(std::move(source).value());
  }
  return opened;
}

}  // namespace hulltrack
