#include "daemon/pipeline/publication.hpp"

#include <utility>

#include "daemon/pipeline/command_word.hpp"

namespace hulltrack {
namespace {

Nanoseconds age_of(const TrackResult& result, MeasurementTime now) { return now - result.time; }

void put_pose(const TrackResult& result, MeasurementTime now, WriteBlock& block) {
  const Eigen::Vector3d displacement = result.pose.displacement();
  const Eigen::Vector3d rpy = result.pose.rpy();
  block.frame = result.frame;
  block.x_m = displacement.x();
  block.y_m = displacement.y();
  block.z_m = displacement.z();
  block.roll_deg = degrees(rpy.x());
  block.pitch_deg = degrees(rpy.y());
  block.yaw_deg = degrees(rpy.z());
  block.age_ms = to_milliseconds(age_of(result, now));
  block.sigma_translation_m = result.sigma_translation < 0.0 ? kUnknownSigma : result.sigma_translation;
  block.sigma_rotation_deg = result.sigma_rotation < 0.0 ? kUnknownSigma : degrees(result.sigma_rotation);
}

void put_metrics(const TrackResult& newest, WriteBlock& block) {
  block.matched = newest.matched;
  if (newest.metrics.valid) {
    block.q1_m = newest.metrics.q1;
    block.mean_m = newest.metrics.mean;
    block.median_m = newest.metrics.median;
    block.q3_m = newest.metrics.q3;
    block.rms_m = newest.metrics.rms;
  }
}

}  // namespace

void Publication::begin_anew(Nanoseconds max_age) {
  max_age_ = max_age;
  if (std::exchange(any_frame_, false)) {
    frames_before_ = newest_.frame + 1;
  }
}

void Publication::frame(const TrackResult& result, MeasurementTime now, Nanoseconds processing) {
  any_frame_ = true;
  newest_ = result;
  newest_.frame += frames_before_;
  processing_ = processing;
  events(result.faults & fault::events, now);
}

void Publication::events(Faults faults, MeasurementTime now) {
  for (std::size_t bit = 0; bit < event_until_.size(); ++bit) {
    if ((faults >> bit & 1u) != 0) {
      event_until_[bit] = now + kEventHold;
    }
  }
}

WriteBlock Publication::block(const PublicationContext& context, MeasurementTime now) {
  WriteBlock block;
  block.state = state(context, now);
  block.health = block.state == State::tracking;
  if (block.health) {
    healthy_ = {true, newest_};
  }
  block.faults = faults(context, now);
  if (healthy_.any) {
    put_pose(healthy_.result, now, block);
  }
  put_metrics(newest_, block);
  block.processing_ms = to_milliseconds(processing_);
  block.command_echo = context.command;
  return block;
}

State Publication::state(const PublicationContext& context, MeasurementTime now) const {
  if (context.stopped) {
    return State::stopped;
  }
  if ((context.command & kCommandHold) != 0) {
    return State::held;
  }
  if (!any_frame_) {
    return context.out_of_service ? State::fault : State::starting;
  }
  if (context.every_lidar_silent || (context.standing & (fault::plc_stale | fault::map_unusable)) != 0) {
    return State::fault;
  }
  if (newest_.state == State::tracking) {
    const Nanoseconds age = age_of(newest_, now);
    const bool fresh = age <= max_age_ && age >= -max_age_;
    const bool a_lidar_is_silent = (context.standing & fault::lidar_silent) != 0;
    return newest_.health && fresh && !a_lidar_is_silent ? State::tracking : State::degraded;
  }
  return newest_.state;
}

Faults Publication::faults(const PublicationContext& context, MeasurementTime now) const {
  const auto conditions_of_frame = static_cast<Faults>(newest_.faults & ~fault::events);
  Faults all = context.standing;
  if (any_frame_ && !context.every_lidar_silent) {  // an old frame's conditions say nothing about now
    all |= conditions_of_frame;
  }
  for (std::size_t bit = 0; bit < event_until_.size(); ++bit) {
    if (now < event_until_[bit]) {
      all |= static_cast<Faults>(1u << bit);
    }
  }
  return all;
}

}  // namespace hulltrack
