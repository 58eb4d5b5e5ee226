#include "core/tracking/motion_products.hpp"

namespace hulltrack {
namespace {

ShipMotion as_motion(const Eigen::Vector4d& v) { return {v[0], v[1], v[2], v[3]}; }

/// Weight of a pose in the slope: 0 at the oldest (u = -1) and the newest (u = 1), 1 in the middle. With
/// equal weights a swing of amplitude A and period P changes a slope over T by up to 6/pi A P / T^2: heave of
/// 5 cm at 15 s changes the draft rate by 1.4 m/h. These weights vanish at both ends, and so does their
/// derivative. With them it is 210/pi^3 A P^3 / T^4, 0.3 m/h; the price is 1.5 times the noise.
double weight(double u) {
  const double w = 1.0 - u * u;
  return w * w;
}

}  // namespace

MotionGauge::MotionGauge(const Box& mapped_H)
    : middle_H_((mapped_H.min + mapped_H.max).cast<double>() / 2.0),
      mapped_length_(static_cast<double>(mapped_H.max.x() - mapped_H.min.x())) {}

MotionProducts MotionGauge::update(MeasurementTime time, bool health, const HullPose& pose) {
  forget(time);
  MotionProducts products;
  products.mapped_length = mapped_length_;
  if (health) {
    const double draft = middle_H_.z() - (pose.T_W_H * middle_H_).z();
    const Eigen::Vector3d rpy = pose.rpy();
    entries_.push_back({time, {draft, rpy.x(), rpy.y(), pose.displacement().x()}});
    products.now = as_motion(entries_.back().values);
  }
  products.rate = rate();
  return products;
}

void MotionGauge::forget(MeasurementTime now) {
  if (entries_.empty()) {
    return;
  }
  const Nanoseconds away = now - entries_.back().time;
  if (away <= Nanoseconds{0} || away > kAway) {  // a gap, or time that does not advance
    entries_.clear();
  }
  while (!entries_.empty() && now - entries_.front().time > kWindow) {
    entries_.pop_front();
  }
}

std::optional<ShipMotion> MotionGauge::rate() const {
  if (entries_.size() < kFewest || entries_.back().time - entries_.front().time < kShortest) {
    return std::nullopt;
  }
  const MeasurementTime oldest = entries_.front().time;
  const double half = to_seconds(entries_.back().time - oldest) / 2.0;
  double w_sum = 0.0;
  double t_sum = 0.0;
  double tt_sum = 0.0;
  Eigen::Vector4d v_sum = Eigen::Vector4d::Zero();
  Eigen::Vector4d tv_sum = Eigen::Vector4d::Zero();
  const Eigen::Vector4d& first = entries_.front().values;  // taken off against loss of digits
  for (const Entry& entry : entries_) {
    const double t = to_seconds(entry.time - oldest) - half;
    const double w = weight(t / half);
    w_sum += w;
    t_sum += w * t;
    tt_sum += w * t * t;
    v_sum += w * (entry.values - first);
    tv_sum += w * t * (entry.values - first);
  }
  return as_motion((tv_sum - t_sum / w_sum * v_sum) / (tt_sum - t_sum * t_sum / w_sum));
}

}  // namespace hulltrack
