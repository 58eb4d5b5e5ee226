#include "plc/sim/plc_server.hpp"

#include <poll.h>
#include <sys/eventfd.h>
#include <unistd.h>

#include <condition_variable>
#include <mutex>
#include <stdexcept>
#include <thread>
#include <utility>
#include <vector>

#include "plc/sim/connections.hpp"
#include "plc/sim/fault_injection.hpp"
#include "plc/sim/modbus_protocol.hpp"

namespace hulltrack::sim {
namespace {

SteadyTime steady_now() { return std::chrono::steady_clock::now(); }

bool readable_now(int fd) {
  pollfd waiting{.fd = fd, .events = POLLIN, .revents = 0};
  return poll(&waiting, 1, 0) > 0;
}

Connections::Door door_of(PlcFault fault) {
  return fault == PlcFault::refuse       ? Connections::Door::refused
         : fault == PlcFault::black_hole ? Connections::Door::black_hole
                                         : Connections::Door::open;
}

}  // namespace

struct PlcServer::Impl {
  PlcServerConfig config;
  mutable std::mutex mutex;  // everything below but `thread`
  mutable std::condition_variable written;
  ModbusProtocol protocol;
  Connections connections;
  FaultInjection faults;
  int wake = eventfd(0, EFD_CLOEXEC | EFD_NONBLOCK);
  bool stopping = false;

  PlcReading current;   // this PLC cycle's
  PlcReading previous;  // the one before

  std::uint64_t requests = 0;
  std::optional<PlcWriteRecord> last_write;
  std::function<void(const PlcWriteRecord&)> on_write;
  std::thread thread;

  explicit Impl(PlcServerConfig settings)
      : config(std::move(settings)),
        connections(config.bind, config.port),
        faults(config.read.base, config.dribble) {
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
      std::vector<pollfd> fds{{.fd = wake, .events = POLLIN, .revents = 0}};
      connections.add_to(fds);  // [1] listens, clients follow
      const int timeout = connections.milliseconds_to_next_due(steady_now());
      const std::uint64_t seen = connections.generation();
      lock.unlock();
      poll(fds.data(), fds.size(), timeout);
      lock.lock();
      std::uint64_t drained = 0;
      while (::read(wake, &drained, sizeof drained) > 0) {
      }
      connections.send_due(steady_now());
      if (seen != connections.generation()) continue;
      // Clients before the listener: a client that reconnects has closed its old socket first.
      for (std::size_t i = 2; i < fds.size(); ++i) {
        if (fds[i].revents != 0) serve_client(fds[i].fd);
      }
      if (fds[1].revents != 0) {
        faults.fault() == PlcFault::pool_full ? connections.accept_and_close() : connections.accept();
      }
    }
  }

  /// Every request that has arrived, or the end of the connection.
  void serve_client(int fd) {
    do {
      const Bytes request = protocol.receive(fd);
      if (request.empty()) {
        connections.drop(fd);
        return;
      }
      ++requests;
      const PlcFault active = faults.meeting(request);
      answer(fd, request, active);
      if (active != PlcFault::none && faults.met()) present_joints();
      if (active == PlcFault::reset) return;
    } while (readable_now(fd));
  }

  void answer(int fd, const Bytes& request, PlcFault active) {
    connections.release(fd);
    if (active == PlcFault::reset) connections.reset(fd);
    if (active == PlcFault::reset || active == PlcFault::silent) return;
    const unsigned exception = exception_of(active, function_of(request));
    Bytes reply = protocol.reply(request, exception);
    if (exception == 0) record_write(request);
    if (reply.empty()) return;
    if (active == PlcFault::late_reply) {
      connections.hold_back(fd, std::move(reply));
      return;
    }
    const SteadyTime now = steady_now();
    for (Chunk& chunk : faults.mangle(std::move(reply), active)) {
      chunk.delay > Nanoseconds{0} ? connections.send_at(now + chunk.delay, fd, std::move(chunk.bytes))
                                   : connections.send(fd, chunk.bytes);
    }
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
    const PlcReading shown = shown_reading(faults.fault(), current, previous, config.read);
    std::vector<std::uint16_t> block = encode_read_block(shown, config.read);
    if (faults.fault() == PlcFault::torn_words)
      tear_words(block, encode_read_block(previous, config.read), config.read);
    int address = config.read.base;
    for (const std::uint16_t value : block) protocol.at(address++) = value;
  }

  void change_fault(PlcFault next, int limit) {
    faults.set(next, limit);
    present_joints();
    if (next == PlcFault::refuse || next == PlcFault::pool_full) connections.reset_all();
    connections.set_door(door_of(next));
    wake_up();
  }
};

PlcServer::PlcServer(PlcServerConfig config) : impl_(std::make_unique<Impl>(std::move(config))) {}
PlcServer::~PlcServer() = default;

std::uint16_t PlcServer::port() const { return impl_->connections.port(); }

void PlcServer::set_joints(double travel_m, double slew_deg, double luff_deg) {
  const std::lock_guard lock(impl_->mutex);
  PlcReading& current = impl_->current;
  impl_->previous = current;
  current.travel_m = travel_m;
  current.slew_deg = slew_deg;
  current.luff_deg = luff_deg;
  if (impl_->faults.fault() != PlcFault::frozen_heartbeat) ++current.heartbeat;
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
  return impl_->connections.accepted();
}

int PlcServer::open_connections() const {
  const std::lock_guard lock(impl_->mutex);
  return static_cast<int>(impl_->connections.open());
}

int PlcServer::most_connections() const {
  const std::lock_guard lock(impl_->mutex);
  return static_cast<int>(impl_->connections.most_open());
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
