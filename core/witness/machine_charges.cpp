#include "core/witness/machine_charges.hpp"

#include <algorithm>

namespace hulltrack {

bool MachineCharges::any() const {
  return std::any_of(slots_.begin(), slots_.end(), [](const auto& charge) { return charge.has_value(); });
}

std::string MachineCharges::reason() const {
  if (slots_.at(newest_)) {
    return slots_.at(newest_)->reason;
  }
  const auto other =
      std::find_if(slots_.begin(), slots_.end(), [](const auto& charge) { return charge.has_value(); });
  return other != slots_.end() ? (*other)->reason : std::string{};
}

void MachineCharges::add(const MachineCharge& charge) {
  newest_ = slot(charge.joint);
  slots_.at(newest_) = charge;
}

const MachineCharge* MachineCharges::next_joint() {
  for (std::size_t i = 0; i < kAllJoints.size(); ++i) {
    asked_ = (asked_ + 1) % kAllJoints.size();
    if (slots_.at(asked_)) {
      return &*slots_.at(asked_);
    }
  }
  return nullptr;
}

const MachineCharge* MachineCharges::without_joint() const {
  return slots_.at(kAllJoints.size()) ? &*slots_.at(kAllJoints.size()) : nullptr;
}

}  // namespace hulltrack
