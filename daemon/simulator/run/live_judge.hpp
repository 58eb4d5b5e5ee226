// Is what the PLC gets true? Compares every write block of the service with the simulation.
//
// The pose in a block is that of its scan: `age_ms` before the block was written. Times are those of the
// simulation (0 = first firing). Pure bookkeeping: no clock, no I/O. Thread rule: one owner.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "daemon/simulator/run/simulated_berth.hpp"
#include "plc/write_block.hpp"

namespace hulltrack {

class LiveJudge {
 public:
  /// `berth` must outlive this.
  explicit LiveJudge(const SimulatedBerth& berth) : berth_(&berth) {}

  /// One block arrived in the PLC at `time`.
  void add(const WriteBlock& block, Nanoseconds time);

  /// Where the ship is.
  [[nodiscard]] std::string ship_line(Nanoseconds time) const;

  /// What the PLC sees now, against the truth: one line without newline.
  [[nodiscard]] std::string line(Nanoseconds time) const;

  /// The run in some lines: healthy share, worst healthy error, departure.
  [[nodiscard]] std::vector<std::string> summary(Nanoseconds end) const;

 private:
  struct Offset {
    double metres = 0.0;  // at the reference point
    double degrees = 0.0;
  };
  [[nodiscard]] Offset offset(const WriteBlock& block, Nanoseconds time) const;
  [[nodiscard]] std::optional<Nanoseconds> departure() const;

  const SimulatedBerth* berth_;
  std::optional<WriteBlock> last_;
  Offset last_offset_;
  std::uint64_t blocks_ = 0;
  std::optional<Nanoseconds> first_healthy_;
  std::uint64_t berthed_blocks_ = 0;  // from the first healthy one to the departure
  std::uint64_t berthed_healthy_ = 0;
  Offset worst_healthy_;
  std::optional<Nanoseconds> last_healthy_;
  Offset last_healthy_offset_;
};

}  // namespace hulltrack
