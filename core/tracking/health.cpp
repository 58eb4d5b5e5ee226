#include "core/tracking/health.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "core/base/text.hpp"

namespace hulltrack {
namespace {

// Two poses are each off by less than 5 cm. A hull that moves no faster than kFastestHull can show this much
// beyond kFastestHull * dt before a jump is no longer explained by errors.
constexpr double kJumpNoise = 0.10;  // m
const double kTurnNoise = radians(0.3);
// A moored ship rolls by a degree in a quarter of 8 s.
const double kTurnRate = radians(1.0);  // 1/s
// Three sigma of MotionRecord's rate of yaw, each yaw with 0.016 deg of noise of its own. In 50,000 simulated
// healthy frames it was off by more in one, by 0.1003.
const double kYawRateNoise = radians(0.1);  // 1/s

/// What the checks found: the worst state they leave, all fault bits, the first reason of the worst.
struct Findings {
  State state = State::tracking;
  Faults faults = 0;
  std::string reason;

  void add(State at_best, Faults bits, std::string why) {
    faults |= bits;
    if (at_best > state) {  // tracking 1 < degraded 2 < lost 3
      state = at_best;
      reason = std::move(why);
    }
  }
};

void check_registration(const HealthLimits& limits, const Evidence& e, Findings& findings) {
  const auto least = static_cast<std::uint32_t>(std::max(0, limits.health.min_matched));
  if (!e.registered || e.matched < least) {
    findings.add(State::lost, fault::few_matches,
                 counted(e.matched, "matched point") + format_text(", min_matched is %u", least));
  }
  if (!e.converged) {
    findings.add(e.registered ? State::degraded : State::lost, fault::not_converged, e.trouble);
  }
}

/// Q1 against what this sensor should see at this pose. With few surfels within metric_range it is no
/// witness, neither for nor against: integrity is, which looks farther and takes health away where it has few
/// as well.
void check_ratio(const HealthConfig& health, const DistanceMetrics& metrics, Findings& findings) {
  if (!metrics.q1_expected) {
    if (!metrics.few_surfels && !health.q1_healthy) {
      findings.add(State::degraded, fault::q1_high,
                   format_text("Q1 is %.3f m; nothing tells what it should be, and q1_healthy is not set",
                               metrics.q1));
    }
    return;
  }
  const double ratio = metrics.q1 / *metrics.q1_expected;
  const auto check = [&](State at_best, double limit, const char* name) {
    if (!(ratio <= limit)) {
      findings.add(at_best, fault::q1_high,
                   format_text("Q1 %.3f m is %.2f times the %.3f m that this sensor should see, %s is %.2f",
                               metrics.q1, ratio, *metrics.q1_expected, name, limit));
    }
  };
  check(State::lost, health.q1_ratio_lost, "q1_ratio_lost");
  check(State::degraded, health.q1_ratio_healthy, "q1_ratio_healthy");
}

/// Q1 against the limits that a site sets.
void check_q1(const HealthConfig& health, double q1, Findings& findings) {
  const auto check = [&](State at_best, const std::optional<double>& limit, const char* name) {
    if (limit && !(q1 <= *limit)) {
      findings.add(at_best, fault::q1_high, format_text("Q1 %.3f m is above %s %.3f m", q1, name, *limit));
    }
  };
  check(State::lost, health.q1_lost, "q1_lost");
  check(State::degraded, health.q1_healthy, "q1_healthy");
}

void check_distances(const HealthLimits& limits, const Evidence& e, Findings& findings) {
  if (!e.metrics.valid) {
    findings.add(State::lost, fault::q1_high, "no part of the map is in view");
    return;
  }
  check_ratio(limits.health, e.metrics, findings);
  check_q1(limits.health, e.metrics.q1, findings);
}

void check_integrity(const Evidence& e, Findings& findings) {
  if (e.integrity.faults != 0) {
    const bool contradicted = (e.integrity.faults & fault::contradicted) != 0;
    findings.add(contradicted ? State::lost : State::degraded, e.integrity.faults, e.integrity.reason);
  }
}

/// The quay's word on the machine. It also tells a hull that really ran from one that only seemed to.
void check_machine(HealthMemory& memory, const Evidence& e, Findings& findings) {
  if (e.machine.faults != 0) {
    findings.add(State::degraded, e.machine.faults, e.machine.reason);
  }
  if (e.machine.confirmed) {
    memory.run.reset();
    memory.ran_away = false;
  }
}

void check_envelope(const HealthLimits& limits, const Evidence& e, Findings& findings) {
  const Eigen::Vector3d& d = e.displacement;
  const bool inside =
      (d.array() >= limits.envelope_min.array()).all() && (d.array() <= limits.envelope_max.array()).all();
  if (!inside) {
    findings.add(
        State::lost, fault::implausible,
        format_text("displacement %.2f, %.2f, %.2f m is outside hull.envelope", d.x(), d.y(), d.z()));
  }
}

/// No ship lies at a quay heeled, trimmed or turned like this: it is a machine whose slew, luff or mount is
/// not what the configuration says, or an alignment that went wrong.
void check_attitude(const HealthLimits& limits, const Evidence& e, Findings& findings) {
  static constexpr std::array<std::pair<const char*, const char*>, 3> kWords = {
      {{"heel", "max_heel"}, {"be trimmed", "max_trim"}, {"be turned", "max_yaw"}}};
  const Eigen::Vector3d rpy = rpy_from_rotation(e.rotation);
  for (Eigen::Index axis = 0; axis < 3; ++axis) {
    if (!(std::abs(rpy[axis]) <= limits.max_rpy[axis])) {
      const auto& [seems_to, key] = kWords[static_cast<std::size_t>(axis)];
      findings.add(State::lost, fault::implausible,
                   format_text("the hull seems to %s by %.1f deg, hull.%s is %.1f deg: is a sign, scale or "
                               "bias of slew or luff wrong, or a LiDAR's mount?",
                               seems_to, degrees(rpy[axis]), key, degrees(limits.max_rpy[axis])));
    }
  }
}

/// Does the pose follow from the one before? Ends `unique` when the hull was out of sight for too long.
void check_continuity(HealthMemory& memory, const Evidence& e, Findings& findings) {
  if (!memory.track.followed) {
    return;
  }
  const double dt = std::max(0.0, to_seconds(e.time - memory.track.followed->time));
  const double reach = kFastestHull * dt + kJumpNoise;
  if (reach > kUnseen) {
    memory.track.unique = false;
    memory.track.followed.reset();
    memory.track.motion = MotionRecord{};
    return;
  }
  const double jump = (e.displacement - memory.track.followed->displacement).norm();
  if (!memory.track.unique && jump > reach) {  // the search found a better place
    memory.track.motion = MotionRecord{};
    return;
  }
  if (jump > reach) {
    findings.add(State::degraded, fault::implausible,
                 format_text("pose jumped by %.2f m in %.1f s, at most %.2f m is possible", jump, dt, reach));
  }
  const double turn = rotation_angle(memory.track.followed->rotation.transpose() * e.rotation);
  if (turn > kTurnRate * dt + kTurnNoise) {
    findings.add(State::degraded, fault::implausible,
                 format_text("pose turned by %.2f deg in %.1f s", degrees(turn), dt));
  }
}

/// Of the fastest part of the hull beyond what noise explains, m/s; with words for it. Nothing while slow.
struct FastPart {
  double speed;
  std::string words;
};
std::optional<FastPart> fast_part(const HealthLimits& limits, const MotionRecord::Motion& motion) {
  const double speed = motion.velocity.norm();
  if (speed > limits.max_speed) {
    return FastPart{
        speed, format_text("the hull moves at %.2f m/s, max_speed is %.2f m/s", speed, limits.max_speed)};
  }
  const double turning = std::abs(motion.rpy_rate.z());
  const double ends = turning * limits.half_length;
  if (ends - kYawRateNoise * limits.half_length > limits.max_speed) {
    return FastPart{ends, format_text("the hull turns at %.2f deg/s and its ends at %.2f m/s, max_speed is "
                                      "%.2f m/s",
                                      degrees(turning), ends, limits.max_speed)};
  }
  return std::nullopt;
}

/// The run goes on over a pause as long as the record in which a speed is sought, since noise makes gaps.
void note_run(HealthMemory& memory, MeasurementTime time, double speed) {
  if (!memory.run || time - memory.run->last > MotionRecord::kWindow) {
    memory.run = {0.0, time};
  }
  memory.run->length += speed * std::max(0.0, to_seconds(time - memory.run->last));
  memory.run->last = time;
  memory.ran_away = memory.ran_away || memory.run->length > kLongestRun;
}

void check_speed(const HealthLimits& limits, HealthMemory& memory, MeasurementTime time, Findings& findings) {
  if (const auto motion = memory.track.motion.motion()) {
    if (auto fast = fast_part(limits, *motion)) {
      note_run(memory, time, fast->speed);
      findings.add(State::degraded, fault::implausible, std::move(fast->words));
    }
  }
  if (memory.ran_away) {
    findings.add(
        State::lost, fault::implausible,
        format_text("the hull seems to have run more than %.0f m faster than max_speed: she is or was "
                    "under way, or an encoder stands still while the loader moves. When she is moored "
                    "and travel, slew and luff are right: a re-acquire edge",
                    kLongestRun));
  }
}

/// Ends the search when all of the berth was searched and one place is left.
void check_uniqueness(HealthMemory& memory, const SearchEvidence& search, Findings& findings) {
  if (memory.track.unique) {
    return;
  }
  if (search.tried < search.starts) {
    findings.add(State::degraded, 0,
                 format_text("searching the berth: %zu of %zu places tried", search.tried, search.starts));
  } else if (search.rival) {
    const Eigen::Vector3d& d = *search.rival;
    findings.add(
        State::lost, fault::ambiguous,
        format_text("the hull may as well lie at displacement %.1f, %.1f, %.1f m", d.x(), d.y(), d.z()));
  } else if (findings.state == State::tracking) {
    memory.track.unique = true;
  }
}

HealthVerdict idle(HealthMemory& memory, State state, Faults faults, std::string reason) {
  memory.good_frames = 0;
  memory.state = state;
  return {state, faults, std::move(reason)};
}

HealthVerdict judge_pose(const HealthLimits& limits, HealthMemory& memory, const Evidence& e) {
  Findings findings;
  findings.faults = e.standing;
  check_registration(limits, e, findings);
  check_machine(memory, e, findings);
  if (e.registered) {
    check_distances(limits, e, findings);
    check_integrity(e, findings);
    check_continuity(memory, e, findings);
    if (findings.state != State::lost && (findings.faults & fault::implausible) == 0) {
      memory.track.followed = FollowedPose{e.time, e.displacement, e.rotation};
      memory.track.motion.add(e.time, e.displacement, rpy_from_rotation(e.rotation));
    }
    check_envelope(limits, e, findings);
    check_attitude(limits, e, findings);
    check_speed(limits, memory, e.time, findings);
  }

  const bool a_lidar_is_silent = (e.standing & fault::lidar_silent) != 0;
  memory.good_frames = findings.state == State::tracking && !a_lidar_is_silent ? memory.good_frames + 1 : 0;
  if (e.registered && e.integrity.undecided) {
    findings.add(State::degraded, 0, e.integrity.reason);
  }
  check_uniqueness(memory, e.search, findings);
  if (e.joints_on_trial) {  // good frames count: once the values are believed, these had the right ones too
    findings.add(State::degraded, fault::plc_value, e.joint_trouble);
  }
  if ((e.standing & fault::foreign_packets) != 0) {
    findings.add(State::degraded, fault::foreign_packets,
                 "two sensors send to one LiDAR's port and nobody can say which is meant; set `source`");
  }
  if (a_lidar_is_silent) {  // what the others see may well follow the hull, but not steer by
    findings.add(State::degraded, fault::lidar_silent, "a LiDAR is silent");
  }
  if (findings.state == State::tracking && memory.state != State::tracking &&
      memory.good_frames < limits.health.recover_frames) {
    findings.add(State::degraded, 0,
                 format_text("recovering: %s of %d",
                             counted(static_cast<std::uint64_t>(memory.good_frames), "good frame").c_str(),
                             limits.health.recover_frames));
  }
  if (!memory.track.unique) {
    findings.state = State::acquiring;
  }
  memory.state = findings.state;
  return {findings.state, findings.faults, std::move(findings.reason)};
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
                                                    const Evidence& e) {
  if (e.reacquire) {
    memory = HealthMemory{};
    memory.state = State::acquiring;
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
  return {std::move(memory), std::move(verdict)};
}

}  // namespace hulltrack
