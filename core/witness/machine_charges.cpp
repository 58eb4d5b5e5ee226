#include "core/witness/machine_charges.hpp"

#include <algorithm>

namespace hulltrack {

bool MachineCharges::any() const {
  return std::any_of(slots_.begin(), slots_.end(), [](const auto& charge) { return charge.has_value(); });
}

std::string MachineCharges::reason() const {
  if (slots_.at(newest_)) {
    return slots_.at(newest_)->charge.reason;
  }
  const auto other =
      std::find_if(slots_.begin(), slots_.end(), [](const auto& charge) { return charge.has_value(); });
  return other != slots_.end() ? (*other)->charge.reason : std::string{};
}

void MachineCharges::add(const MachineCharge& charge) {
  newest_ = slot(charge);
  slots_.at(newest_) = {charge};
}

std::optional<WrongJoint> MachineCharges::next_joint() {
  for (std::size_t i = 0; i < kAllJoints.size(); ++i) {
    asked_ = (asked_ + 1) % kAllJoints.size();
    if (slots_.at(asked_)) {
      return std::get<WrongJoint>(slots_.at(asked_)->charge.what);
    }
  }
  return std::nullopt;
}

void MachineCharges::hear_at(std::size_t slot, bool refuted) {
  std::optional<Slot>& heard = slots_.at(slot);
  if (!heard) {
    return;
  }
  heard->refuted = refuted ? heard->refuted + 1 : 0;
  if (heard->refuted >= kNeeded) {
    heard.reset();
  }
}

void MachineCharges::refute_none() {
  for (std::optional<Slot>& slot : slots_) {
    if (slot) {
      slot->refuted = 0;
    }
  }
}

std::size_t MachineCharges::slot(const MachineCharge& charge) {
  const auto* of_joint = std::get_if<WrongJoint>(&charge.what);
  return of_joint != nullptr ? static_cast<std::size_t>(of_joint->joint)
                             : kAllJoints.size() + charge.what.index() - 1;
}

}  // namespace hulltrack
