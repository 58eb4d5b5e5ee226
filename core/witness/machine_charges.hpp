// The machine's open charges: why it counts as worn beyond its class (ICD 3.1), which costs health.
//
// There is room for six: one for each joint, and one each for latency, the sensor's place, and a machine that
// is off by an unknown amount. A new charge does not drop those of other kinds: two explanations may fit one
// scan equally well. The owner drops each charge when frames disprove it. No failure. Thread rule: a plain
// value.
#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <string>
#include <type_traits>
#include <variant>
#include <vector>

#include "core/witness/machine_wear.hpp"

namespace hulltrack {

/// A joint that reads `amount` too much, m or rad.
struct WrongJoint {
  JointName joint = JointName::travel;
  double amount = 0.0;
};
/// Joint values that are older by `older` than plc.latency_ms says, s; negative: younger. `rate`: of the
/// joints when that was seen, m/s and rad/s by JointName.
struct WrongLatency {
  double older = 0.0;
  Eigen::Vector3d rate = Eigen::Vector3d::Zero();
};
/// A sensor that is off by the twist `off` about its own position, because of its mount or several joints.
struct WrongPlace {
  MachineStand stand;  // of the machine when that was seen
  Twist off = Twist::Zero();
  std::vector<Twist> unheld;  // what was not seen of it: Misplacement::unheld(), about the sensor's position
  bool beyond_gate = false;   // too large to show as offsets from planes
};
/// A machine that is so far off that the scan does not tell by how much: it sees through the quay's surfaces.
struct WrongAltogether {};

struct MachineCharge {
  std::string reason;
  std::variant<WrongJoint, WrongLatency, WrongPlace, WrongAltogether> what;
};

class MachineCharges {
 public:
  /// Frames in a row, to charge and to acquit: one frame may be wrong about the quay.
  static constexpr int kNeeded = 3;

  [[nodiscard]] bool any() const;
  /// The text of the newest charge, or of another if that has been dropped; empty without charges.
  [[nodiscard]] std::string reason() const;

  /// Replaces the charge of the same joint, or of the same kind if it is not a joint's.
  void add(const MachineCharge& charge);

  /// One of the charged joints. Each call goes on to the next one, in turn; nothing if no joint is charged.
  [[nodiscard]] std::optional<WrongJoint> next_joint();
  /// The charge of kind `Wrong`, which is not WrongJoint; nothing if there is none.
  template <typename Wrong>
  [[nodiscard]] std::optional<Wrong> charged() const {
    const auto& slot = slots_.at(slot_of<Wrong>());
    return slot ? std::optional(std::get<Wrong>(slot->charge.what)) : std::nullopt;
  }

  /// A frame's word on a charge: the last of kNeeded frames in a row that refute it drops it.
  void hear(JointName joint, bool refuted) { hear_at(static_cast<std::size_t>(joint), refuted); }
  template <typename Wrong>
  void hear(bool refuted) {
    hear_at(slot_of<Wrong>(), refuted);
  }
  /// A frame that refutes no charge.
  void refute_none();
  void drop_all() { slots_ = {}; }

 private:
  /// Index in slots_: joints by JointName, then the other kinds in the variant's order.
  [[nodiscard]] static std::size_t slot(const MachineCharge& charge);
  template <typename Wrong>
  [[nodiscard]] static std::size_t slot_of() {
    static_assert(!std::is_same_v<Wrong, WrongJoint>, "joints have a slot each");
    return slot({.reason = {}, .what = Wrong{}});
  }

  void hear_at(std::size_t slot, bool refuted);

  struct Slot {
    MachineCharge charge;
    int refuted = 0;  // frames in a row
  };
  std::array<std::optional<Slot>, 6> slots_;
  std::size_t newest_ = 0;  // slot of the charge that was added last
  std::size_t asked_ = 0;   // joint that next_joint() gave last
};

}  // namespace hulltrack
