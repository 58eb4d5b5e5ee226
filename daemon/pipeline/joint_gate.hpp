// Which of the joint values that the PLC presents are believed?
//
// A poll whose heartbeat has not changed brings no sample (where the PLC has a heartbeat). A sample is
// believed as a whole or not at all:
//   range   A value that is not finite or outside min..max is refused.
//   motion  What the machine cannot have done since the last believed sample is refused (see
//           joint_track.hpp); so is a change faster than max_rate. The next sample that fits is believed.
//           Samples up to 250 ms apart are interpolated, so that a single refused one costs nothing.
//   gap     After 250 ms without a believed sample (JointHistory::kMaxGap), values in range are on trial:
//           scans may be registered with them, but nothing is healthy. They are believed if
//           (a) all joints stood still before the gap, and for 250 ms are within 2 cm or .05 deg of there; or
//           (b) the gap is below 1 s, and the half seconds before and after it fit one motion with constant
//               acceleration, to half the contract. The quarter of a second just before the gap is left
//               out: what went wrong may have begun before it was noticed; or
//           (c) the quay map confirms the joints of frames within the trial (frame_done); or
//           (d) a re-acquire edge says that a person has checked them.
//           (b) does not apply to a trial that began with samples refused by their motion.
// So a refused value does not become plausible because time passes. After the start or a re-acquire edge the
// first values in range are believed; a gap before these have lasted half a second counts as a new start.
// SI units. No failure but the verdict. Thread rule: one owner. Cost: that of two JointTracks.
#pragma once

#include <array>
#include <optional>
#include <string>

#include "core/base/status.hpp"
#include "core/kinematics/joint_track.hpp"
#include "core/kinematics/joints.hpp"

namespace hulltrack {

/// What one joint can do: m or rad, max_rate per second.
struct JointLimits {
  double min = 0.0;
  double max = 0.0;
  double max_rate = 0.0;
};

struct JointGateConfig {
  JointLimits travel, slew, luff;
  Nanoseconds poll_period = std::chrono::milliseconds(20);
  bool has_heartbeat = true;
  bool has_command = true;  // the PLC can raise a re-acquire edge
};

/// One poll's answer.
struct JointReading {
  JointSample sample;
  std::uint16_t heartbeat = 0;
};

class JointGate {
 public:
  enum class Verdict { believed, on_trial, no_news, refused };

  struct Outcome {
    Verdict verdict = Verdict::no_news;
    Faults faults = 0;        // plc_value while the newest values are not believed
    std::string reason;       // why not, with joint and figures; empty otherwise
    bool needs_edge = false;  // neither (a) nor (b) can come true any more: only (c) or (d)
  };

  explicit JointGate(const JointGateConfig& config);

  /// Whether `reading` is new: later than the last one, and with another heartbeat (where the PLC has one).
  [[nodiscard]] bool is_news(const JointReading& reading) const;

  /// Judges the next reading; readings come in order of time (an earlier one is no news).
  [[nodiscard]] Outcome offer(const JointReading& reading);

  /// Re-acquire edge: forgets everything, so that the next values in range are believed.
  void reacquire();

  /// To be called for each frame, measured in [first, last]. `confirmed`: the quay map confirms its joints on
  /// all six axes. Five such frames in a row within a trial end it and its values are believed. If one frame
  /// in a hundred were confirmed by chance, that would happen by chance once in 10^10 frames; a shift of
  /// waiting has 3 * 10^5.
  void frame_done(MeasurementTime first, MeasurementTime last, bool confirmed);

 private:
  struct Joint {
    const char* name;
    const char* unit;
    double display;  // factor from SI to the unit shown
    JointLimits limits;
  };
  struct Trial {
    JointTrack track;
    bool at_old_place = false;  // (a) may still come true: every sample is where the joints stood before
    bool fits_motion = false;   // (b) may still come true
    int confirmed = 0;          // confirmed frames in a row
  };

  [[nodiscard]] Outcome judge(const JointSample& sample);
  [[nodiscard]] Outcome believe(const JointSample& sample);
  [[nodiscard]] Outcome refuse_motion(const JointSample& sample, const JointTrack::Misfit& misfit);
  [[nodiscard]] Outcome try_out(const JointSample& sample);
  void begin_trial(const JointSample& sample, bool contradicts);
  void continue_trial(const JointSample& sample);
  [[nodiscard]] bool trial_confirms();
  [[nodiscard]] bool is_one_motion() const;
  void believe_trial();
  void end_trial();

  [[nodiscard]] std::string out_of_range(const JointSample& sample) const;
  [[nodiscard]] std::string misfit_words(const JointSample& sample, const JointTrack::Misfit& misfit) const;
  [[nodiscard]] std::string trial_words(const JointSample& sample, bool needs_edge) const;

  JointGateConfig config_;
  std::array<Joint, 3> joints_;
  JointTrack believed_;
  bool established_ = false;  // the believed samples span half a second, or came out of a trial
  Trial trial_;
  std::optional<JointReading> last_;
  Outcome last_outcome_;
};

}  // namespace hulltrack
