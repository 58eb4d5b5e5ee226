// Which of the joint values that the PLC presents are believed?
//
// A poll whose heartbeat has not changed brings no sample (where the PLC has a heartbeat). Each joint
// is then judged alone; the sample is believed only if all three joints are:
//   range  a value that is not finite or outside min..max is refused.
//   rate   |v - v_ref| > max_rate * (t - t_ref + poll_period) is refused, v_ref being the joint's last
//          believed value; one poll period is the uncertainty of two stamps.
//   back   a joint refused by its rate stays refused until its value comes back: within the allowance
//          frozen when it was refused, or, after a single spike on a moving joint, with a value that
//          breaks with the refused one and that the reference reaches in t - t_ref <= 250 ms.
//          Time alone never makes a value believed; a persistent step waits for reacquire().
// SI units (m, rad, s). No failure but the verdict. Thread rule: one owner. Cost: constant.
#pragma once

#include <array>
#include <optional>
#include <string>

#include "core/base/status.hpp"
#include "core/kinematics/joints.hpp"

namespace hulltrack {

/// What one joint can do, m or rad and per second.
struct JointLimits {
  double min = 0.0;
  double max = 0.0;
  double max_rate = 0.0;
};

struct JointGateConfig {
  JointLimits travel, slew, luff;
  Nanoseconds poll_period = std::chrono::milliseconds(20);
  bool has_heartbeat = true;
};

/// One poll's answer.
struct JointReading {
  JointSample sample;
  std::uint16_t heartbeat = 0;
};

class JointGate {
 public:
  enum class Verdict { believed, no_news, refused };

  struct Outcome {
    Verdict verdict = Verdict::no_news;
    Faults faults = 0;   // plc_value while the newest values are refused
    std::string reason;  // of a refusal, with joint and figures; empty otherwise
  };

  explicit JointGate(const JointGateConfig& config);

  /// Whether `reading` is more than the last one again: its heartbeat moved (where the PLC has one), and it
  /// is later.
  [[nodiscard]] bool is_news(const JointReading& reading) const;

  /// Judges the next reading; readings come in order of time (an earlier one is no news).
  [[nodiscard]] Outcome offer(const JointReading& reading);

  /// Re-acquire edge: forgets every reference, so that the next values in range are believed.
  void reacquire();

 private:
  struct Joint {
    const char* name;
    const char* unit;
    double display;  // factor from SI to the unit shown
    JointLimits limits;
    std::optional<double> reference;  // last believed value
    MeasurementTime reference_time{};
    std::optional<double> refused;  // last value refused by its rate; empty = the joint is believed
    MeasurementTime refused_time{};
    double frozen_allowance = 0.0;
  };

  [[nodiscard]] std::string judge(Joint& joint, double value, MeasurementTime time) const;
  [[nodiscard]] bool comes_back(const Joint& joint, double value, MeasurementTime time) const;
  [[nodiscard]] double reach(const Joint& joint, Nanoseconds elapsed) const;

  JointGateConfig config_;
  std::array<Joint, 3> joints_;
  std::optional<JointReading> last_;
  Outcome last_outcome_;
};

}  // namespace hulltrack
