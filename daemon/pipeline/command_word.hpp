// The PLC's command word (ICD 2.1): its bits, and the memory that turns a level into an edge.
//
// Thread rule: one owner. Starts with the word 0.
#pragma once

#include <cstdint>

namespace hulltrack {

inline constexpr std::uint16_t kCommandHold = 1u << 0;
inline constexpr std::uint16_t kCommandReacquire = 1u << 1;

/// Keeps a re-acquire edge until a frame takes it, so that none between two frames is missed.
class CommandLatch {
 public:
  /// A command word as read; true on a rising re-acquire edge.
  bool read(std::uint16_t command) {
    const bool edge = (command & kCommandReacquire) != 0 && (command_ & kCommandReacquire) == 0;
    command_ = command;
    reacquire_ = reacquire_ || edge;
    return edge;
  }
  [[nodiscard]] std::uint16_t command() const { return command_; }
  [[nodiscard]] bool hold() const { return (command_ & kCommandHold) != 0; }
  /// True once after each edge.
  [[nodiscard]] bool take_reacquire() {
    const bool taken = reacquire_;
    reacquire_ = false;
    return taken;
  }

 private:
  std::uint16_t command_ = 0;
  bool reacquire_ = false;
};

}  // namespace hulltrack
