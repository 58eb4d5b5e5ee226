// What the machine stands charged with: each joint by itself, and what names none.
//
// A joint that is charged may look right where another value of another joint explains the scan as well, so
// that no charge is dropped for another one, but each when it is acquitted. Thread rule: a plain value.
#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <string>

#include "core/witness/machine_wear.hpp"

namespace hulltrack {

/// Why the machine is beyond its class.
struct MachineCharge {
  std::string reason;
  std::optional<JointName> joint;  // if it is one joint's
  double amount = 0.0;             // that it reads too much, m, rad
  std::size_t directions = 0;      // in how many the quay was seen
};

class MachineCharges {
 public:
  [[nodiscard]] bool any() const;
  /// Of the last one that was made, or of any other that stands; empty without one.
  [[nodiscard]] std::string reason() const;

  /// Replaces what was charged to the same joint.
  void add(const MachineCharge& charge);

  /// A joint's charge, the next one's each time; null without any. Lives until the next call of another
  /// function.
  [[nodiscard]] const MachineCharge* next_joint();
  /// Null if there is none.
  [[nodiscard]] const MachineCharge* without_joint() const;

  /// nullopt: what names no joint.
  void drop(std::optional<JointName> joint) { slots_.at(slot(joint)).reset(); }
  void drop_all() { slots_ = {}; }

 private:
  [[nodiscard]] static std::size_t slot(std::optional<JointName> joint) {
    return joint ? static_cast<std::size_t>(*joint) : kAllJoints.size();
  }

  std::array<std::optional<MachineCharge>, kAllJoints.size() + 1> slots_;
  std::size_t newest_ = 0;
  std::size_t asked_ = 0;
};

}  // namespace hulltrack
