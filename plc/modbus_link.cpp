#include "plc/modbus_link.hpp"

#include <modbus/modbus.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <stdexcept>
#include <utility>

#include "plc/host_resolver.hpp"
#include "plc/tcp_connect.hpp"

namespace hulltrack {
namespace {

using namespace std::chrono_literals;

constexpr Nanoseconds kFirstBackOff = 200ms;
constexpr Nanoseconds kLongestBackOff = 1s;
constexpr Nanoseconds kShortestTimeout = 1ms;  // what is left for a reply after a slow connect, at least

/// Wait before the next connection attempt after `failures` in a row: 0, 0.2, 0.4, 0.8, 1, 1 ... s.
Nanoseconds back_off(int failures) {
  if (failures <= 1) return Nanoseconds{0};
  const Nanoseconds doubled = kFirstBackOff * (1 << std::min(failures - 2, 8));
  return std::min(doubled, kLongestBackOff);
}

int exception_code(int error) {
  return error > MODBUS_ENOBASE && error < MODBUS_ENOBASE + MODBUS_EXCEPTION_MAX ? error - MODBUS_ENOBASE : 0;
}

LinkOutcome classify(int error) {
  if (exception_code(error) != 0) return LinkOutcome::exception;
  if (error == ETIMEDOUT) return LinkOutcome::timeout;
  return error >= MODBUS_ENOBASE ? LinkOutcome::garbled : LinkOutcome::closed;
}

/// One request, in words for messages.
struct Request {
  bool is_write;
  int address;
  int count;
  const char* key;

  [[nodiscard]] std::string words() const {
    return std::string(is_write ? "writing" : "reading") + " holding registers " + std::to_string(address) +
           " to " + std::to_string(address + count - 1) + " (" + key + ")";
  }
};

/// What an exception reply means and which key to look at.
std::string exception_words(int code, const Request& request) {
  const std::string key = request.key;
  switch (code) {
    case MODBUS_EXCEPTION_ILLEGAL_FUNCTION:
      return std::string("exception 01, illegal function: the PLC does not offer function code ") +
             (request.is_write ? "16" : "03") + " at unit id plc.unit_id; enable it in the PLC";
    case MODBUS_EXCEPTION_ILLEGAL_DATA_ADDRESS:
      return "exception 02, illegal data address: the PLC has no such registers" +
             std::string(request.is_write ? " or protects them" : "") + "; check " + key + ".base" +
             (request.is_write ? "" : " and the offsets in [" + key + "]");
    case MODBUS_EXCEPTION_ILLEGAL_DATA_VALUE:
      return "exception 03, illegal data value: the PLC does not take " + std::to_string(request.count) +
             " registers in one request; check " + key + ".base and the size of the PLC's block";
    case MODBUS_EXCEPTION_SLAVE_OR_SERVER_BUSY:
      return "exception 06, busy: tried again at the next turn";
    case MODBUS_EXCEPTION_GATEWAY_PATH:
    case MODBUS_EXCEPTION_GATEWAY_TARGET:
      return "a gateway answers, but not the PLC behind it; check plc.unit_id";
    default:
      return "exception " + std::to_string(code) + ", " + modbus_strerror(MODBUS_ENOBASE + code) +
             "; look into the PLC's diagnostics, " + key + ".base names the block";
  }
}

struct FreeModbus {
  void operator()(modbus_t* context) const {
    modbus_close(context);
    modbus_free(context);
  }
};

}  // namespace

const char* outcome_name(LinkOutcome outcome) {
  switch (outcome) {
    case LinkOutcome::ok:
      return "ok";
    case LinkOutcome::exception:
      return "exception";
    case LinkOutcome::timeout:
      return "timeout";
    case LinkOutcome::garbled:
      return "garbled";
    case LinkOutcome::closed:
      return "closed";
    case LinkOutcome::unreachable:
      return "unreachable";
    case LinkOutcome::waiting:
      return "waiting";
  }
  return "unknown";
}

struct ModbusLink::Impl {
  ModbusLinkConfig config;
  Clock now;
  HostResolver resolver;
  std::unique_ptr<modbus_t, FreeModbus> context;
  int failures = 0;  // in a row, since the last reply
  SteadyTime retry_at{};
  std::uint64_t connections = 0;

  Impl(ModbusLinkConfig settings, Clock clock)
      : config(std::move(settings)),
        now(clock ? std::move(clock) : Clock([] { return SteadyTime(std::chrono::steady_clock::now()); })),
        resolver(config.host, config.port),
        context(modbus_new_tcp(nullptr, config.port)) {
    if (!context) throw std::runtime_error("cannot create a Modbus context: out of memory");
    if (config.response_timeout <= Nanoseconds{0}) {
      throw std::invalid_argument("plc.response_timeout_ms must be above 0");
    }
    if (modbus_set_slave(context.get(), config.unit_id) != 0) {
      throw std::invalid_argument("plc.unit_id must be 0 to 247, or 255");
    }
    // Off: then the response timeout bounds the whole reply (libmodbus manual, modbus_set_byte_timeout),
    // however slowly its bytes dribble in.
    modbus_set_byte_timeout(context.get(), 0, 0);
    modbus_set_error_recovery(context.get(), MODBUS_ERROR_RECOVERY_NONE);
  }

  [[nodiscard]] bool connected() const { return modbus_get_socket(context.get()) >= 0; }

  LinkResult failed(LinkOutcome outcome, std::string message) {
    modbus_close(context.get());
    ++failures;
    retry_at = now() + back_off(failures);
    return {.outcome = outcome, .message = std::move(message)};
  }

  /// ok when there is a connection.
  LinkResult connect() {
    if (connected()) return {.outcome = LinkOutcome::ok};
    if (now() < retry_at) return {.outcome = LinkOutcome::waiting};
    const SteadyTime begun = now();
    const Result<SocketAddress> address = resolver.next(config.response_timeout);
    if (!address) return failed(LinkOutcome::unreachable, "no connection: " + address.error().message);
    const Nanoseconds left = std::max(config.response_timeout - (now() - begun), kShortestTimeout);
    const Result<int> socket = connect_within(*address, left);
    if (!socket) {
      resolver.failed();
      return failed(LinkOutcome::unreachable, "no connection: " + socket.error().message +
                                                  "; check its power, the cable, plc.host and plc.port");
    }
    modbus_set_socket(context.get(), *socket);
    ++connections;
    return {.outcome = LinkOutcome::ok};
  }

  /// `exchange` sends one request and receives its reply: -1 and errno on failure, as libmodbus does.
  template <typename Exchange>
  LinkResult run(const Request& request, Exchange exchange) {
    const SteadyTime begun = now();
    if (LinkResult connection = connect(); !connection.ok()) return connection;
    LinkResult result;
    result.requested = now();
    set_response_timeout(std::max(config.response_timeout - (result.requested - begun), kShortestTimeout));
    const bool done = exchange(context.get()) != -1;
    const int error = errno;
    result.answered = now();
    result.outcome = done ? LinkOutcome::ok : classify(error);
    if (!result.link_up()) return failed(result.outcome, error_words(result.outcome, error, request));
    failures = 0;
    if (!done) {
      result.exception = exception_code(error);
      result.message = request.words() + ": " + exception_words(result.exception, request);
    }
    return result;
  }

  void set_response_timeout(Nanoseconds timeout) const {
    const auto us = std::chrono::duration_cast<std::chrono::microseconds>(timeout).count();
    modbus_set_response_timeout(context.get(), static_cast<std::uint32_t>(us / 1'000'000),
                                static_cast<std::uint32_t>(us % 1'000'000));
  }

  [[nodiscard]] std::string error_words(LinkOutcome outcome, int error, const Request& request) const {
    const std::string what = request.words() + ": ";
    switch (outcome) {
      case LinkOutcome::timeout:
        return what + "no complete reply within plc.response_timeout_ms = " +
               std::to_string(
                   std::chrono::round<std::chrono::milliseconds>(config.response_timeout).count()) +
               "; reconnecting";
      case LinkOutcome::garbled:
        return what + "the reply is not the one to this request; reconnecting";
      default:
        return what + "connection lost (" + modbus_strerror(error) + "); reconnecting";
    }
  }
};

ModbusLink::ModbusLink(ModbusLinkConfig config, Clock now)
    : impl_(std::make_unique<Impl>(std::move(config), std::move(now))) {}
ModbusLink::~ModbusLink() = default;

LinkResult ModbusLink::read(int address, std::span<std::uint16_t> registers, const char* key) {
  const int count = static_cast<int>(registers.size());
  std::array<std::uint16_t, MODBUS_MAX_READ_REGISTERS> reply{};
  const LinkResult result = impl_->run(
      {.is_write = false, .address = address, .count = count, .key = key},
      [&](modbus_t* context) { return modbus_read_registers(context, address, count, reply.data()); });
  if (result.ok()) std::copy_n(reply.begin(), registers.size(), registers.begin());
  return result;
}

LinkResult ModbusLink::write(int address, std::span<const std::uint16_t> registers, const char* key) {
  const int count = static_cast<int>(registers.size());
  return impl_->run(
      {.is_write = true, .address = address, .count = count, .key = key},
      [&](modbus_t* context) { return modbus_write_registers(context, address, count, registers.data()); });
}

void ModbusLink::end_back_off() { impl_->retry_at = {}; }

bool ModbusLink::connected() const { return impl_->connected(); }
std::uint64_t ModbusLink::connections() const { return impl_->connections; }

}  // namespace hulltrack
