#include "daemon/simulator/run/live_judge.hpp"

#include <algorithm>

#include "core/base/text.hpp"

namespace hulltrack {

std::optional<Nanoseconds> LiveJudge::departure() const {
  const auto start = under_way(berth_->hull().config());
  if (!start) return std::nullopt;
  return nanoseconds_from_ms(*start * 1e3);
}

LiveJudge::Offset LiveJudge::offset(const WriteBlock& block, Nanoseconds time) const {
  const ShipPose truth = berth_->truth(time - nanoseconds_from_ms(block.age_ms));
  const Eigen::Vector3d displacement(block.x_m, block.y_m, block.z_m);
  const Eigen::Vector3d rpy(radians(block.roll_deg), radians(block.pitch_deg), radians(block.yaw_deg));
  const Eigen::Matrix3d turn = rotation_from_rpy(rpy) * rotation_from_rpy(truth.rpy).transpose();
  return {(displacement - truth.displacement).norm(), degrees(rotation_angle(turn))};
}

void LiveJudge::add(const WriteBlock& block, Nanoseconds time) {
  last_ = block;
  last_offset_ = offset(block, time);
  ++blocks_;
  if (block.health && !first_healthy_) first_healthy_ = time;
  const bool berthed = !departure() || time < *departure();
  if (first_healthy_ && berthed) {
    ++berthed_blocks_;
    berthed_healthy_ += block.health ? 1 : 0;
  }
  if (!block.health) return;
  last_healthy_ = time;
  last_healthy_offset_ = last_offset_;
  worst_healthy_.metres = std::max(worst_healthy_.metres, last_offset_.metres);
  worst_healthy_.degrees = std::max(worst_healthy_.degrees, last_offset_.degrees);
}

std::string LiveJudge::ship_line(Nanoseconds time) const {
  const ShipPose truth = berth_->truth(time);
  return format_text("%6.1f s  ship x %+.3f y %+.3f z %+.3f m", to_seconds(time), truth.displacement.x(),
                     truth.displacement.y(), truth.displacement.z());
}

std::string LiveJudge::line(Nanoseconds time) const {
  const std::string head = ship_line(time);
  if (!last_) return head + " | the PLC has heard nothing yet";
  const WriteBlock& b = *last_;
  const std::string seen = format_text(" | PLC: %-9s health %d  x %+.3f y %+.3f z %+.3f m  Q1 ",
                                       state_name(b.state), b.health ? 1 : 0, b.x_m, b.y_m, b.z_m) +
                           (b.q1_m < kUnknownDistance ? format_text("%.3f m", b.q1_m) : std::string("-"));
  if (!b.health) return head + seen + format_text("  faults 0x%04X", unsigned{b.faults});
  return head + seen +
         format_text("  off by %.1f mm %.3f deg, %.0f ms old", last_offset_.metres * 1e3,
                     last_offset_.degrees, b.age_ms);
}

std::vector<std::string> LiveJudge::summary(Nanoseconds end) const {
  if (blocks_ == 0) return {"the service never wrote to the PLC"};
  std::vector<std::string> lines = {counted(blocks_, "write block") + " received"};
  if (!first_healthy_) {
    lines.emplace_back("health was never 1");
    return lines;
  }
  lines.push_back(format_text("first healthy at %.1f s; from then on healthy in %.2f %% of the blocks %s",
                              to_seconds(*first_healthy_),
                              berthed_blocks_ > 0 ? 100.0 * static_cast<double>(berthed_healthy_) /
                                                        static_cast<double>(berthed_blocks_)
                                                  : 0.0,
                              departure() ? "until the ship set off" : "of the run"));
  lines.push_back(format_text("worst healthy pose: %.1f mm and %.3f deg off the truth",
                              worst_healthy_.metres * 1e3, worst_healthy_.degrees));
  if (!departure() || end <= *departure()) return lines;
  const bool still_healthy = last_->health;
  if (still_healthy)
    lines.push_back(
        format_text("the ship set off at %.1f s and health is still 1", to_seconds(*departure())));
  else
    lines.push_back(
        format_text("the ship set off at %.1f s; last health 1 came %+.1f s from then, %.1f mm off",
                    to_seconds(*departure()), to_seconds(*last_healthy_ - *departure()),
                    last_healthy_offset_.metres * 1e3));
  return lines;
}

}  // namespace hulltrack
