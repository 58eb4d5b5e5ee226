// How does the PLC stand? Judges polls and writes: faults for the registers, words for the log.
//
// When its data are stale is said in standing.hpp. Each condition has one line when it begins and one when it
// ends. Thread rule: one owner (the plc thread). `now` is handed in.
#pragma once

#include <string>

#include "daemon/log/condition_log.hpp"
#include "daemon/pipeline/joint_gate.hpp"
#include "daemon/pipeline/standing.hpp"
#include "plc/plc_client.hpp"

namespace hulltrack {

class PlcWatch {
 public:
  /// `log` must outlive this object. Data counts as new at `start`.
  PlcWatch(const PlcConfig& config, LogSink& log, SteadyTime start);

  void polled(const PlcPoll& poll, SteadyTime now);
  void judged(const JointGate::Outcome& outcome, SteadyTime now);
  void wrote(const PlcWrite& write, SteadyTime now);

  /// plc_stale and plc_value as they stand.
  [[nodiscard]] Faults standing(SteadyTime now);

  /// True while the link has been lost since the last write that reached the PLC.
  [[nodiscard]] bool link_was_lost() const { return link_was_lost_; }

 private:
  void update_link(LinkOutcome outcome, const std::string& message, SteadyTime now);

  PlcConfig config_;
  std::string name_;  // "PLC 192.168.10.10:502"
  PlcNews news_;
  Faults value_fault_ = 0;
  bool link_was_lost_ = false;
  bool link_up_ = false;
  std::string link_message_;
  std::string refusal_;  // what the newest poll was answered with, if it was an exception
  ConditionLog link_log_, read_log_, write_log_, stale_log_, value_log_, wait_log_, overwritten_log_;
};

}  // namespace hulltrack
