#include "core/tracking/health.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "core/base/text.hpp"
#include "core/tracking/continuity.hpp"
#include "core/tracking/objections.hpp"

namespace hulltrack {
namespace {

void check_registration(const HealthLimits& limits, const FrameFindings& e, Objections& objections) {
  const auto least = static_cast<std::uint32_t>(std::max(0, limits.health.min_matched));
  if (!e.registration.found || e.registration.matched < least) {
    objections.add(
        State::lost, fault::few_matches,
        counted(e.registration.matched, "matched point") + format_text(", min_matched is %u", least));
  }
  if (!e.registration.converged) {
    objections.add(e.registration.found ? State::degraded : State::lost, fault::not_converged,
                   e.registration.trouble);
  }
}

/// Compares Q1 with what this sensor should see at this pose. If few surfels within metric_range leave that
/// unknown, the check is skipped: integrity looks farther, and it objects itself if it has few surfels. If it
/// is unknown for another reason, the frame is degraded unless the site has set q1_healthy.
void check_ratio(const HealthConfig& health, const DistanceMetrics& metrics, Objections& objections) {
  if (!metrics.q1_expected) {
    if (!metrics.few_surfels && !health.q1_healthy) {
      objections.add(State::degraded, fault::q1_high,
                     format_text("Q1 is %.3f m; nothing tells what it should be, and q1_healthy is not set",
                                 metrics.q1));
    }
    return;
  }
  const double ratio = metrics.q1 / *metrics.q1_expected;
  const auto check = [&](State at_best, double limit, const char* name) {
    if (!(ratio <= limit)) {
      objections.add(at_best, fault::q1_high,
                     format_text("Q1 %.3f m is %.2f times the %.3f m that this sensor should see, %s is %.2f",
                                 metrics.q1, ratio, *metrics.q1_expected, name, limit));
    }
  };
  check(State::lost, health.q1_ratio_lost, "q1_ratio_lost");
  check(State::degraded, health.q1_ratio_healthy, "q1_ratio_healthy");
}

/// Compares Q1 with the limits that a site sets.
void check_q1(const HealthConfig& health, double q1, Objections& objections) {
  const auto check = [&](State at_best, const std::optional<double>& limit, const char* name) {
    if (limit && !(q1 <= *limit)) {
      objections.add(at_best, fault::q1_high, format_text("Q1 %.3f m is above %s %.3f m", q1, name, *limit));
    }
  };
  check(State::lost, health.q1_lost, "q1_lost");
  check(State::degraded, health.q1_healthy, "q1_healthy");
}

void check_distances(const HealthLimits& limits, const FrameFindings& e, Objections& objections) {
  if (!e.examination.metrics.valid) {
    objections.add(State::lost, fault::q1_high, "no part of the map is in view");
    return;
  }
  check_ratio(limits.health, e.examination.metrics, objections);
  check_q1(limits.health, e.examination.metrics.q1, objections);
}

void check_integrity(const FrameFindings& e, Objections& objections) {
  if (e.examination.integrity.faults != 0) {
    const bool contradicted = e.contradicted();
    objections.add(contradicted ? State::lost : State::degraded, e.examination.integrity.faults,
                   e.examination.integrity.reason);
  }
}

/// A frame is degraded while the witnesses (the quay, or the hull's motion with a joint) contradict the
/// machine. A frame in which a quay map confirms all joints ends a run: no joint is wrong then.
void check_machine(HealthMemory& memory, const FrameFindings& e, Objections& objections) {
  if (e.machine.faults != 0) {
    objections.add(State::degraded, e.machine.faults, e.machine.reason);
  }
  if (e.machine.confirmed) {
    memory.run.reset();
    memory.ran_away = false;
  }
}

void check_envelope(const HealthLimits& limits, const FrameFindings& e, Objections& objections) {
  const Eigen::Vector3d d = e.registration.pose.displacement();
  const bool inside =
      (d.array() >= limits.envelope_min.array()).all() && (d.array() <= limits.envelope_max.array()).all();
  if (!inside) {
    objections.add(
        State::lost, fault::implausible,
        format_text("displacement %.2f, %.2f, %.2f m is outside hull.envelope", d.x(), d.y(), d.z()));
  }
}

/// Lost if roll, pitch or yaw of T_W_H is beyond max_heel, max_trim or max_yaw. No moored ship lies like
/// that: slew, luff or a mount is not what the configuration says, or the alignment went wrong.
void check_attitude(const HealthLimits& limits, const FrameFindings& e, Objections& objections) {
  static constexpr std::array<std::pair<const char*, const char*>, 3> kWords = {
      {{"heel", "max_heel"}, {"be trimmed", "max_trim"}, {"be turned", "max_yaw"}}};
  const Eigen::Vector3d rpy = e.registration.pose.rpy();
  for (Eigen::Index axis = 0; axis < 3; ++axis) {
    if (!(std::abs(rpy[axis]) <= limits.max_rpy[axis])) {
      const auto& [seems_to, key] = kWords[static_cast<std::size_t>(axis)];
      objections.add(State::lost, fault::implausible,
                     format_text("the hull seems to %s by %.1f deg, hull.%s is %.1f deg: is a sign, scale or "
                                 "bias of slew or luff wrong, or a LiDAR's mount?",
                                 seems_to, degrees(rpy[axis]), key, degrees(limits.max_rpy[axis])));
    }
  }
}

/// While the place is not certain: degraded until all starts of the search are tried, then lost if another
/// place explains the scan as well. If none does and no check objects, the place is certain (`unique`). A
/// search that was wanted before the place was lost says nothing.
void check_uniqueness(HealthMemory& memory, const SearchProgress& search, Objections& objections) {
  if (memory.track.unique) {
    return;
  }
  const bool of_now = search.number == memory.track.searches;
  if (!of_now || search.tried < search.starts) {
    objections.add(State::degraded, 0,
                   format_text("searching the berth: %zu of %zu places tried", of_now ? search.tried : 0,
                               search.starts));
  } else if (search.rival) {
    const Eigen::Vector3d& d = *search.rival;
    objections.add(
        State::lost, fault::ambiguous,
        format_text("the hull may as well lie at displacement %.1f, %.1f, %.1f m", d.x(), d.y(), d.z()));
  } else if (objections.state == State::tracking) {
    memory.track.unique = true;
  }
}

HealthVerdict idle(HealthMemory& memory, State state, Faults faults, std::string reason) {
  memory.good_frames = 0;
  memory.state = state;
  return {state, faults, std::move(reason)};
}

HealthVerdict judge_pose(const HealthLimits& limits, HealthMemory& memory, const FrameFindings& e) {
  Objections objections;
  objections.faults = e.standing;
  check_registration(limits, e, objections);
  check_machine(memory, e, objections);
  if (e.registration.found) {
    check_distances(limits, e, objections);
    check_integrity(e, objections);
    check_continuity(memory, e, objections);
    if (objections.state != State::lost && (objections.faults & fault::implausible) == 0) {
      memory.track.followed = FollowedPose{e.time, e.registration.pose};
      memory.track.speed_record.add(e.time, e.registration.pose.displacement(), e.registration.pose.rpy());
    }
    check_envelope(limits, e, objections);
    check_attitude(limits, e, objections);
    check_speed(limits, memory, e.time, objections);
  }

  const bool a_lidar_is_silent = (e.standing & fault::lidar_silent) != 0;
  memory.good_frames = objections.state == State::tracking && !a_lidar_is_silent ? memory.good_frames + 1 : 0;
  if (e.registration.found && e.examination.integrity.undecided) {
    objections.add(State::degraded, 0, e.examination.integrity.reason);
  }
  check_uniqueness(memory, e.search, objections);
  if (e.joints_on_trial) {  // still a good frame: health is back at once when the values prove right
    objections.add(State::degraded, fault::plc_value, e.joint_trouble);
  }
  if ((e.standing & fault::foreign_packets) != 0) {
    objections.add(State::degraded, fault::foreign_packets,
                   "two sensors send to one LiDAR's port and nobody can say which is meant; set `source`");
  }
  if (a_lidar_is_silent) {  // the others still follow the hull, but nobody may steer by that
    objections.add(State::degraded, fault::lidar_silent, "a LiDAR is silent");
  }
  if (objections.state == State::tracking && memory.state != State::tracking &&
      memory.good_frames < limits.health.recover_frames) {
    objections.add(State::degraded, 0,
                   format_text("recovering: %s of %d",
                               counted(static_cast<std::uint64_t>(memory.good_frames), "good frame").c_str(),
                               limits.health.recover_frames));
  }
  if (!memory.track.unique) {
    objections.state = State::acquiring;
  }
  memory.state = objections.state;
  return {objections.state, objections.faults, std::move(objections.reason)};
}

}  // namespace

HealthLimits health_limits(const TrackerConfig& config, double half_length) {
  return {config.health,
          config.hull.envelope.min.cast<double>(),
          config.hull.envelope.max.cast<double>(),
          Eigen::Vector3d(config.hull.max_heel, config.hull.max_trim, config.hull.max_yaw),
          config.hull.max_speed,
          half_length};
}

std::pair<HealthMemory, HealthVerdict> judge_health(const HealthLimits& limits, HealthMemory memory,
                                                    const FrameFindings& e) {
  if (e.reacquire) {
    const std::uint64_t searches = memory.track.searches + 1;
    memory = HealthMemory{};
    memory.state = State::acquiring;
    memory.track.searches = searches;
  }
  HealthVerdict verdict;
  if (e.hold) {
    verdict = idle(memory, State::held, e.standing, "held by the PLC's command");
  } else if ((e.standing & fault::plc_stale) != 0 || !e.bracketed) {
    const auto faults = static_cast<Faults>(e.standing | fault::plc_stale);
    verdict = idle(memory, State::fault, faults,
                   "no joint samples bracket the scan" +
                       (e.joint_trouble.empty() ? std::string{} : ": " + e.joint_trouble));
  } else {
    verdict = judge_pose(limits, memory, e);
  }
  if (memory.track.followed && memory.track.unique) {
    memory.track.last_unique = memory.track.followed;
  }
  return {std::move(memory), std::move(verdict)};
}

}  // namespace hulltrack
