// Which requests does a fault meet, and what does it make of their replies and of the values shown?
//
// Values in m and deg. Deterministic: garbage is the same in every run. Asks no clock, sends nothing.
// Failure: none. Thread rule: external locking.
#pragma once

#include <random>
#include <vector>

#include "core/base/time.hpp"
#include "plc/plc_config.hpp"
#include "plc/register_codec.hpp"
#include "plc/sim/modbus_protocol.hpp"
#include "plc/sim/plc_fault.hpp"

namespace hulltrack::sim {

/// The exception code with which the fault answers a request; 0 = none.
[[nodiscard]] unsigned exception_of(PlcFault fault, std::uint8_t function);

/// The read block as a PLC program with this fault shows it in the cycle of `current`.
[[nodiscard]] PlcReading shown_reading(PlcFault fault, const PlcReading& current, const PlcReading& previous,
                                       const PlcReadConfig& config);

/// Puts the second register of every joint that has two back to what it was in `previous`.
void tear_words(std::vector<std::uint16_t>& block, const std::vector<std::uint16_t>& previous,
                const PlcReadConfig& config);

/// Bytes of a reply that go out together.
struct Chunk {
  Nanoseconds delay{0};  // from the reply's time
  Bytes bytes;
};

class FaultInjection {
 public:
  /// `dribble`: between the bytes of a dribbled reply.
  FaultInjection(int read_base, Nanoseconds dribble) : read_base_(read_base), dribble_(dribble) {}

  /// `requests` < 0: until another fault is set; otherwise after so many requests that met it.
  void set(PlcFault fault, int requests);
  [[nodiscard]] PlcFault fault() const { return fault_; }

  /// The fault that this request meets; none for the others.
  [[nodiscard]] PlcFault meeting(const Bytes& request) const;
  /// A request has met the fault. True if that was the last one, and the server is sound again.
  [[nodiscard]] bool met();

  /// How a reply goes out under `fault`.
  [[nodiscard]] std::vector<Chunk> mangle(Bytes reply, PlcFault fault);

 private:
  void spoil(Bytes& reply);

  int read_base_;
  Nanoseconds dribble_;
  PlcFault fault_ = PlcFault::none;
  int requests_left_ = -1;
  std::mt19937 random_{1};
};

}  // namespace hulltrack::sim
