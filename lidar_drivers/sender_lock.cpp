#include "lidar_drivers/sender_lock.hpp"

namespace hulltrack {

bool SenderLock::takes(std::uint32_t ip, MeasurementTime received) {
  if (!first_ || ip == *first_) {
    return true;
  }
  const bool first_is_silent = received - first_heard_ > timeout_;
  const bool has_had_company = alone_ && second_;
  if (first_is_silent && !has_had_company) {
    return true;  // it becomes the first once it is decoded
  }
  second_ = ip;
  since_ = alone_ ? since_ : received;
  ++dropped_;
  return false;
}

void SenderLock::decoded(std::uint32_t ip, MeasurementTime received) {
  if (!first_ || ip != *first_) {
    second_ = second_ == ip ? first_ : std::nullopt;
    first_ = ip;
    since_ = received;
    alone_ = false;
  }
  first_heard_ = received;
  if (!alone_ && received - since_ >= kAlone) {
    alone_ = true;
  }
}

}  // namespace hulltrack
