#include "daemon/service/rx_thread.hpp"

#include <sys/epoll.h>
#include <unistd.h>

#include <cerrno>
#include <stdexcept>
#include <system_error>

#include "core/base/text.hpp"
#include "daemon/pipeline/live_time.hpp"

namespace hulltrack {
namespace {

/// Longest sleep: bounds how late silence, a frame's end in silence and a stop are noticed.
constexpr std::chrono::milliseconds kLongestWait{20};
/// How often the LiDARs' state is judged and published.
constexpr std::chrono::milliseconds kLookPeriod{20};
/// Batches (of up to 64 datagrams) taken from one socket before the others have their turn.
constexpr int kBatchesInARow = 16;

template <typename T>
T value_or_throw(Result<T> result) {
  if (!result) {
    throw std::runtime_error(result.error().message);
  }
  return std::move(result).value();
}

}  // namespace

RxThread::RxThread(const Config& config, Exchange& exchange, Pulse& pulse, LogSink& log)
    : exchange_(exchange),
      pulse_(pulse),
      log_(log),
      lidars_(config.lidars),
      sockets_(value_or_throw(open_udp_sources(config.lidars))),
      memories_(sockets_.sources.size()),
      router_(value_or_throw(DatagramRouter::create(config.lidars))),
      builder_(value_or_throw(ScanBuilder::create(config.lidars, config.framing))),
      dropped_log_(log),
      epoll_(epoll_create1(EPOLL_CLOEXEC)) {
  if (epoll_ < 0) {
    throw std::system_error(errno, std::generic_category(), "cannot create an epoll instance");
  }
  for (std::size_t socket = 0; socket < sockets_.sources.size(); ++socket) {
    epoll_event event{};
    event.events = EPOLLIN;
    event.data.u64 = socket;
    epoll_ctl(epoll_, EPOLL_CTL_ADD, sockets_.sources[socket].fd(), &event);
    for (const std::string& warning : sockets_.sources[socket].warnings()) {
      log.write(LogLevel::warning, warning);
    }
  }
  const SteadyTime start = steady_now();
  for (const LidarConfig& lidar : lidars_) {
    watches_.emplace_back(lidar, 60.0 * config.framing.frame_rate_hz, log, start);
  }
}

RxThread::~RxThread() { close(epoll_); }

void RxThread::run(std::stop_token stop) {
  while (!stop.stop_requested()) {
    const SteadyTime now = receive_waiting();
    pulse_.beat(now);
    builder_.advance(live_measurement_time(now));
    hand_over_scans();
    if (now >= next_look_) {
      look_at_lidars(now);
      add_figures();
      next_look_ = now + kLookPeriod;
    }
  }
}

SteadyTime RxThread::receive_waiting() {
  std::array<epoll_event, 16> events;
  const int ready = epoll_wait(epoll_, events.data(), static_cast<int>(events.size()),
                               static_cast<int>(kLongestWait.count()));
  const SteadyTime woken = steady_now();
  for (int i = 0; i < ready; ++i) {
    receive(events[static_cast<std::size_t>(i)].data.u64);
  }
  return woken;
}

void RxThread::receive(std::size_t socket) {
  for (int batch = 0; batch < kBatchesInARow; ++batch) {
    const std::span<const Datagram> datagrams = value_or_throw(sockets_.sources[socket].receive());
    for (const Datagram& datagram : datagrams) {
      if (const auto lidar = router_.lidar_of(datagram)) {
        if (!builder_.takes(*lidar, datagram)) {
          exchange_.events.raise(fault::foreign_packets);
          continue;
        }
        if (builder_.add(*lidar, datagram).refused()) {
          exchange_.events.raise(fault::foreign_packets);
        }
        last_received_ = live_steady_time(datagram.received);
        hand_over_scans();
      }
    }
    if (datagrams.empty()) {
      break;
    }
  }
  tell_of_counters(socket);
}

void RxThread::tell_of_counters(std::size_t socket) {
  const UdpCounters& counters = sockets_.sources[socket].counters();
  SocketMemory& memory = memories_[socket];
  if (counters.foreign > memory.foreign || counters.filtered > memory.filtered) {
    exchange_.events.raise(fault::foreign_packets);
  }
  if (counters.kernel_overflows > memory.kernel_overflows) {
    exchange_.events.raise(fault::frame_incomplete);
  }
  memory = {counters.foreign, counters.filtered, counters.kernel_overflows};
}

void RxThread::hand_over_scans() {
  while (builder_.take(exchange_.scans.writable())) {
    exchange_.scans.writable().last_received = last_received_;
    if (exchange_.publish_scan()) {
      ++dropped_;
      exchange_.events.raise(fault::frame_dropped);
    }
    exchange_.track_bell.ring();
  }
}

void RxThread::look_at_lidars(SteadyTime now) {
  LidarView view{.standing = 0, .every_silent = true, .updated = now};
  for (std::size_t lidar = 0; lidar < lidars_.size(); ++lidar) {
    view.standing |= watches_[lidar].update(counters(lidar), now);
    view.every_silent = view.every_silent && watches_[lidar].silent();
  }
  exchange_.lidars.put(view);
  dropped_log_.update(
      dropped_grows_.update(dropped_, now), now,
      [&] {
        return format_text(
            "scans come faster than they can be processed: %llu left out so far, the newest is used. Is "
            "this computer overloaded?",
            static_cast<unsigned long long>(dropped_));
      },
      [](Nanoseconds) { return std::string("every scan is processed again"); });
}

LidarCounters RxThread::counters(std::size_t lidar) const {
  const UdpSource& socket = sockets_.sources[sockets_.data_of[lidar]];
  return {.status = builder_.status(lidar),
          .last_rejection = builder_.last_rejection(lidar),
          .two_senders = builder_.two_senders(lidar),
          .foreign = socket.counters().foreign,
          .last_foreign = socket.last_foreign(),
          .kernel_overflows = socket.counters().kernel_overflows,
          .filtered = socket.counters().filtered};
}

void RxThread::add_figures() {
  Figures total;
  for (std::size_t lidar = 0; lidar < lidars_.size(); ++lidar) {
    const LidarStatus status = builder_.status(lidar);
    total.packets += status.packets;
    total.packets_lost += status.packets_lost;
    total.packets_refused += status.packets_rejected + status.packets_of_another;
  }
  for (const UdpSource& socket : sockets_.sources) {
    total.packets_refused += socket.counters().foreign;
  }
  total.frames_dropped = dropped_;
  Figures news;
  news.packets = total.packets - told_.packets;
  news.packets_lost = total.packets_lost - told_.packets_lost;
  news.packets_refused = total.packets_refused - told_.packets_refused;
  news.frames_dropped = total.frames_dropped - told_.frames_dropped;
  exchange_.figures.add(news);
  told_ = total;
}

}  // namespace hulltrack
