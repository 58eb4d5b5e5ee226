#include "plc/sim/plc_server.hpp"

#include <modbus/modbus.h>
#include <netinet/in.h>
#include <netinet/tcp.h>
#include <poll.h>
#include <sys/eventfd.h>
#include <sys/socket.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <condition_variable>
#include <limits>
#include <mutex>
#include <random>
#include <span>
#include <stdexcept>
#include <thread>
#include <utility>

#include "plc/sim/listener.hpp"
#include "plc/sim/modbus_protocol.hpp"

namespace hulltrack::sim {
namespace {

struct Client {
  int fd;
  Bytes held_back;  // a late reply
};

/// Bytes that are not due yet.
struct Outgoing {
  SteadyTime due;
  int fd;
  Bytes bytes;
};

SteadyTime steady_now() { return std::chrono::steady_clock::now(); }

bool affects_values(PlcFault fault) { return fault >= PlcFault::frozen_heartbeat; }

/// The exception code with which the fault answers a request; 0 = none.
unsigned exception_of(PlcFault fault, std::uint8_t function) {
  switch (fault) {
    case PlcFault::illegal_function:
      return MODBUS_EXCEPTION_ILLEGAL_FUNCTION;
    case PlcFault::illegal_address:
      return MODBUS_EXCEPTION_ILLEGAL_DATA_ADDRESS;
    case PlcFault::illegal_value:
      return MODBUS_EXCEPTION_ILLEGAL_DATA_VALUE;
    case PlcFault::busy:
      return MODBUS_EXCEPTION_SLAVE_OR_SERVER_BUSY;
    case PlcFault::write_refused:
      return function == kWriteMultipleRegisters ? MODBUS_EXCEPTION_ILLEGAL_DATA_ADDRESS : 0;
    default:
      return 0;
  }
}

void send_all(int fd, std::span<const std::uint8_t> bytes) {
  // A client that has gone is noticed by the next poll.
  [[maybe_unused]] const ssize_t sent = send(fd, bytes.data(), bytes.size(), MSG_NOSIGNAL);
}

bool readable_now(int fd) {
  pollfd waiting{.fd = fd, .events = POLLIN, .revents = 0};
  return poll(&waiting, 1, 0) > 0;
}

void close_with_reset(int fd) {
  const linger now{.l_onoff = 1, .l_linger = 0};
  setsockopt(fd, SOL_SOCKET, SO_LINGER, &now, sizeof now);
  close(fd);
}

}  // namespace

struct PlcServer::Impl {
  PlcServerConfig config;
  mutable std::mutex mutex;  // everything below but `thread`
  mutable std::condition_variable written;
  ModbusProtocol protocol;
  Listener listener;
  int wake = eventfd(0, EFD_CLOEXEC | EFD_NONBLOCK);
  bool stopping = false;
  std::uint64_t generation = 0;  // of the set of descriptors: poll results of an older one are void
  std::vector<Client> clients;
  std::vector<Outgoing> outgoing;

  PlcFault fault = PlcFault::none;
  int fault_requests = kForever;
  std::mt19937 random{1};  // of garbage
  PlcReading current;      // this PLC cycle's
  PlcReading previous;     // the one before

  std::uint64_t requests = 0;
  std::uint64_t connections = 0;
  std::size_t most_connections = 0;
  std::optional<PlcWriteRecord> last_write;
  std::function<void(const PlcWriteRecord&)> on_write;
  std::thread thread;

  explicit Impl(PlcServerConfig settings) : config(std::move(settings)), listener(config.bind, config.port) {
    if (wake < 0) throw std::runtime_error("cannot create the Modbus server: no descriptors left");
    present_joints();
    thread = std::thread([this] { serve(); });
  }

  ~Impl() {
    {
      const std::lock_guard lock(mutex);
      stopping = true;
      wake_up();
    }
    thread.join();
    for (const Client& client : clients) close(client.fd);
    close(wake);
  }

  void wake_up() const {
    const std::uint64_t one = 1;
    [[maybe_unused]] const ssize_t rc = ::write(wake, &one, sizeof one);
  }

  // ---- the server's thread

  void serve() {
    std::unique_lock lock(mutex);
    while (!stopping) {
      std::vector<pollfd> fds = waiting_set();
      const int timeout = milliseconds_to_next_due();
      const std::uint64_t seen = generation;
      lock.unlock();
      poll(fds.data(), fds.size(), timeout);
      lock.lock();
      std::uint64_t drained = 0;
      while (::read(wake, &drained, sizeof drained) > 0) {
      }
      send_due();
      if (seen != generation) continue;
      // Clients before the listener: a client that reconnects has closed its old socket first.
      for (std::size_t i = 2; i < fds.size(); ++i) {
        if (fds[i].revents != 0) serve_client(fds[i].fd);
      }
      if (fds[1].revents != 0) accept_client();
    }
  }

  /// [0] wakes us, [1] listens (poll ignores -1), clients follow.
  [[nodiscard]] std::vector<pollfd> waiting_set() const {
    std::vector<pollfd> fds{{.fd = wake, .events = POLLIN, .revents = 0},
                            {.fd = listener.accepting_fd(), .events = POLLIN, .revents = 0}};
    if (fault == PlcFault::black_hole) return fds;
    for (const Client& client : clients) fds.push_back({.fd = client.fd, .events = POLLIN, .revents = 0});
    return fds;
  }

  [[nodiscard]] int milliseconds_to_next_due() const {
    if (outgoing.empty()) return -1;
    const SteadyTime next = std::ranges::min(outgoing, {}, &Outgoing::due).due;
    const auto left = std::chrono::ceil<std::chrono::milliseconds>(next - steady_now()).count();
    return static_cast<int>(std::max<decltype(left)>(left, 0));
  }

  void send_due() {
    const SteadyTime now = steady_now();
    for (const Outgoing& item : outgoing) {
      if (item.due <= now) send_all(item.fd, item.bytes);
    }
    std::erase_if(outgoing, [now](const Outgoing& item) { return item.due <= now; });
  }

  void accept_client() {
    const int fd = accept4(listener.accepting_fd(), nullptr, nullptr, SOCK_CLOEXEC);
    if (fd < 0) return;
    ++connections;
    if (fault == PlcFault::pool_full) {
      close(fd);
      return;
    }
    const int on = 1;
    setsockopt(fd, IPPROTO_TCP, TCP_NODELAY, &on, sizeof on);
    clients.push_back({.fd = fd, .held_back = {}});
    most_connections = std::max(most_connections, clients.size());
    ++generation;
  }

  void drop_client(int fd, bool with_reset) {
    with_reset ? close_with_reset(fd) : static_cast<void>(close(fd));
    std::erase_if(clients, [fd](const Client& client) { return client.fd == fd; });
    std::erase_if(outgoing, [fd](const Outgoing& item) { return item.fd == fd; });
    ++generation;
  }

  /// Every request that has arrived, or the end of the connection.
  void serve_client(int fd) {
    do {
      const Bytes request = protocol.receive(fd);
      if (request.empty()) {
        drop_client(fd, false);
        return;
      }
      ++requests;
      if (!answer(fd, request)) return;
    } while (readable_now(fd));
  }

  /// False when the connection is gone.
  bool answer(int fd, const Bytes& request) {
    Client& client = *std::ranges::find(clients, fd, &Client::fd);
    send_all(fd, std::exchange(client.held_back, {}));
    const std::uint8_t function = function_of(request);
    const bool met = fault_meets(request);
    const PlcFault active = met ? fault : PlcFault::none;
    if (active == PlcFault::reset) drop_client(fd, true);
    if (active != PlcFault::reset && active != PlcFault::silent) {
      const unsigned exception = exception_of(active, function);
      Bytes reply = protocol.reply(request, exception);
      if (exception == 0) record_write(request);
      deliver(client, std::move(reply), active);
    }
    if (met) count_down();
    return active != PlcFault::reset;
  }

  /// Sends the reply, mangled as the fault says.
  void deliver(Client& client, Bytes reply, PlcFault active) {
    if (reply.empty()) return;
    const std::span<const std::uint8_t> whole(reply);
    switch (active) {
      case PlcFault::late_reply:
        client.held_back = std::move(reply);
        return;
      case PlcFault::wrong_transaction:
        reply.front() ^= 0x55;
        break;
      case PlcFault::duplicate_reply:
        send_all(client.fd, whole);
        break;
      case PlcFault::truncated_reply:
        send_all(client.fd, whole.first(whole.size() / 2));
        return;
      case PlcFault::garbage_reply:
        spoil(reply);
        break;
      case PlcFault::dribbled_reply: {
        SteadyTime due = steady_now();
        for (const std::uint8_t byte : reply) outgoing.push_back({due += config.dribble, client.fd, {byte}});
        return;
      }
      default:
        break;
    }
    send_all(client.fd, reply);
  }

  /// Half of the time the 8 bytes that libmodbus looks at first stay correct.
  void spoil(Bytes& reply) {
    const bool keep_header = (random() & 1u) != 0;
    reply.resize(keep_header ? kMbapLength + 1 + random() % 250 : 1 + random() % 300);
    for (std::size_t i = keep_header ? kMbapLength + 1 : 0; i < reply.size(); ++i) {
      reply[i] = static_cast<std::uint8_t>(random());
    }
  }

  [[nodiscard]] bool fault_meets(const Bytes& request) const {
    const std::uint8_t function = function_of(request);
    if (fault == PlcFault::none) return false;
    if (fault == PlcFault::write_refused) return function == kWriteMultipleRegisters;
    if (affects_values(fault))
      return function == kReadHoldingRegisters && address_of(request) == config.read.base;
    return true;
  }

  void count_down() {
    if (fault_requests == kForever || --fault_requests > 0) return;
    fault = PlcFault::none;
    present_joints();
  }

  void record_write(const Bytes& request) {
    const int base = config.write.base;
    if (function_of(request) != kWriteMultipleRegisters || address_of(request) > base ||
        address_of(request) + count_of(request) < base + kWriteBlockSize) {
      return;
    }
    PlcWriteRecord record{.at = steady_now(), .number = last_write ? last_write->number + 1 : 1};
    for (int i = 0; i < kWriteBlockSize; ++i)
      record.registers[static_cast<std::size_t>(i)] = protocol.at(base + i);
    record.block = decode_write_block(record.registers, config.write);
    last_write = record;
    if (on_write) on_write(record);
    written.notify_all();
  }

  // ---- what the owner sets

  /// The read block as the PLC program shows it now.
  void present_joints() {
    PlcReading shown = current;
    switch (fault) {
      case PlcFault::torn_block:
        shown = previous;
        shown.travel_m = current.travel_m;
        shown.heartbeat = current.heartbeat;
        shown.torn = true;
        break;
      case PlcFault::not_a_number:
        shown.travel_m = std::numeric_limits<double>::quiet_NaN();
        break;
      case PlcFault::infinite:
        shown.travel_m = std::numeric_limits<double>::infinity();
        break;
      case PlcFault::out_of_range:
        shown.travel_m = config.read.travel.max + 1.0;
        break;
      default:
        break;
    }
    int address = config.read.base;
    for (const std::uint16_t value : encode_read_block(shown, config.read)) protocol.at(address++) = value;
  }

  void change_fault(PlcFault next, int limit) {
    const PlcFault last = std::exchange(fault, next);
    fault_requests = limit;
    present_joints();
    if (next == PlcFault::refuse || next == PlcFault::pool_full) {
      while (!clients.empty()) drop_client(clients.back().fd, true);
    }
    const auto closes_port = [](PlcFault f) { return f == PlcFault::refuse || f == PlcFault::black_hole; };
    if (next == PlcFault::refuse) listener.refuse();
    if (next == PlcFault::black_hole) listener.black_hole();
    if (closes_port(last) && !closes_port(next)) listener.open();
    ++generation;
    wake_up();
  }
};

PlcServer::PlcServer(PlcServerConfig config) : impl_(std::make_unique<Impl>(std::move(config))) {}
PlcServer::~PlcServer() = default;

std::uint16_t PlcServer::port() const { return impl_->listener.port(); }

void PlcServer::set_joints(double travel_m, double slew_deg, double luff_deg) {
  const std::lock_guard lock(impl_->mutex);
  PlcReading& current = impl_->current;
  impl_->previous = current;
  current.travel_m = travel_m;
  current.slew_deg = slew_deg;
  current.luff_deg = luff_deg;
  if (impl_->fault != PlcFault::frozen_heartbeat) ++current.heartbeat;
  impl_->present_joints();
}

void PlcServer::set_command(std::uint16_t command) {
  const std::lock_guard lock(impl_->mutex);
  impl_->current.command = impl_->previous.command = command;
  impl_->present_joints();
}

void PlcServer::set_fault(PlcFault fault, int requests) {
  const std::lock_guard lock(impl_->mutex);
  impl_->change_fault(fault, requests);
}

void PlcServer::poke(int address, std::uint16_t value) {
  const std::lock_guard lock(impl_->mutex);
  impl_->protocol.at(address) = value;
}

std::uint16_t PlcServer::peek(int address) const {
  const std::lock_guard lock(impl_->mutex);
  return impl_->protocol.at(address);
}

std::uint64_t PlcServer::requests() const {
  const std::lock_guard lock(impl_->mutex);
  return impl_->requests;
}

std::uint64_t PlcServer::connections() const {
  const std::lock_guard lock(impl_->mutex);
  return impl_->connections;
}

int PlcServer::open_connections() const {
  const std::lock_guard lock(impl_->mutex);
  return static_cast<int>(impl_->clients.size());
}

int PlcServer::most_connections() const {
  const std::lock_guard lock(impl_->mutex);
  return static_cast<int>(impl_->most_connections);
}

std::optional<PlcWriteRecord> PlcServer::last_write() const {
  const std::lock_guard lock(impl_->mutex);
  return impl_->last_write;
}

bool PlcServer::wait_for_writes(std::uint64_t number, Nanoseconds limit) const {
  std::unique_lock lock(impl_->mutex);
  return impl_->written.wait_for(lock, limit,
                                 [&] { return impl_->last_write && impl_->last_write->number >= number; });
}

void PlcServer::on_write(std::function<void(const PlcWriteRecord&)> callback) {
  const std::lock_guard lock(impl_->mutex);
  impl_->on_write = std::move(callback);
}

}  // namespace hulltrack::sim
