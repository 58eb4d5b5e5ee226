// What the machine stands charged with: each joint by itself, latency, the sensor's place, being elsewhere.
//
// What is charged may look right where something else explains the scan as well, so that no charge is
// dropped for another one, but each when it is acquitted. Thread rule: a plain value.
#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <string>
#include <type_traits>
#include <variant>

#include "core/witness/machine_wear.hpp"

namespace hulltrack {

/// A joint that reads so much too much, m or rad.
struct WrongJoint {
  JointName joint = JointName::travel;
  double amount = 0.0;
};
/// Joint values that are so much older than they are taken to be, s.
struct WrongLatency {
  double older = 0.0;
};
/// A sensor that is off by a twist about its place, by the mount or by several joints, as the machine stood.
struct WrongPlace {
  MachineStand stand;
  Twist off = Twist::Zero();
};
/// A machine that is so far off that nothing tells by how much.
struct WrongAltogether {};

/// Why the machine is beyond its class.
struct MachineCharge {
  std::string reason;
  std::variant<WrongJoint, WrongLatency, WrongPlace, WrongAltogether> what;
};

class MachineCharges {
 public:
  [[nodiscard]] bool any() const;
  /// Of the last one that was made, or of any other that stands; empty without one.
  [[nodiscard]] std::string reason() const;

  /// Replaces what was charged to the same joint, or of the same kind.
  void add(const MachineCharge& charge);

  /// The joint that is charged, the next one each time; nothing without any.
  [[nodiscard]] std::optional<WrongJoint> next_joint();
  /// The charge of that kind which is no joint's, if it stands.
  template <typename Wrong>
  [[nodiscard]] std::optional<Wrong> charged() const {
    const auto& charge = slots_.at(slot_of<Wrong>());
    return charge ? std::optional(std::get<Wrong>(charge->what)) : std::nullopt;
  }

  void drop(JointName joint) { slots_.at(static_cast<std::size_t>(joint)).reset(); }
  template <typename Wrong>
  void drop() {
    slots_.at(slot_of<Wrong>()).reset();
  }
  void drop_all() { slots_ = {}; }

 private:
  /// Those of joints come first.
  [[nodiscard]] static std::size_t slot(const MachineCharge& charge);
  template <typename Wrong>
  [[nodiscard]] static std::size_t slot_of() {
    static_assert(!std::is_same_v<Wrong, WrongJoint>, "joints have a slot each");
    return slot({.reason = {}, .what = Wrong{}});
  }

  std::array<std::optional<MachineCharge>, 6> slots_;
  std::size_t newest_ = 0;
  std::size_t asked_ = 0;
};

}  // namespace hulltrack
