#include "daemon/log/state_log.hpp"

#include <utility>

#include "core/base/text.hpp"

namespace hulltrack {
namespace {

constexpr std::array<std::pair<Faults, const char*>, 16> kFaultWords{{
    {fault::plc_link_lost, "PLC link was lost"},
    {fault::plc_stale, "PLC data stale"},
    {fault::plc_value, "joint values not believed"},
    {fault::lidar_silent, "a LiDAR silent"},
    {fault::foreign_packets, "malformed or foreign packets"},
    {fault::frame_incomplete, "packets lost"},
    {fault::not_converged, "registration did not converge"},
    {fault::few_matches, "too few matched points"},
    {fault::q1_high, "Q1 too high"},
    {fault::unconstrained, "the surfaces in view leave a direction free"},
    {fault::implausible, "the pose is implausible"},
    {fault::frame_dropped, "processing fell behind"},
    {fault::clock, "the sensor's clock disagrees"},
    {fault::map_unusable, "the map is unusable"},
    {fault::contradicted, "the scan contradicts the pose"},
    {fault::ambiguous, "another pose would fit as well"},
}};

/// What the state means for the loader and what to do about it.
const char* consequence(State state, Faults faults) {
  const bool pose_is_judged = state == State::degraded || state == State::lost || state == State::acquiring;
  if (pose_is_judged && (faults & fault::plc_value) != 0) {
    return "The PLC sees health 0 for as long as its joint values are not believed, the line about the PLC "
           "says what to do";
  }
  switch (state) {
    case State::starting:
      return "The PLC sees health 0 until the first whole scan has come";
    case State::tracking:
      return "The PLC sees health 1: the pose may steer the loader";
    case State::degraded:
      return "The PLC sees health 0 for now and the last good pose; it returns by itself after some good "
             "frames";
    case State::lost:
      return "The PLC sees health 0: do not steer by the pose. Is this the ship of the map, in view and "
             "moored?";
    case State::acquiring:
      return "The PLC sees health 0 while the hull is being searched for";
    case State::fault:
      return "The PLC sees health 0: an input is missing, the lines about LiDAR and PLC say which";
    case State::held:
      return "The PLC asked for a pause (command bit 0); it sees health 0 until it takes that back";
    case State::stopped:
      return "The PLC sees health 0: the service is stopping";
  }
  return "";
}

/// A line that was held back for longer says since when its state has lasted.
constexpr std::chrono::seconds kWorthTelling{1};

LogLevel level_of(State state) {
  const bool calm = state != State::degraded && state != State::lost && state != State::fault;
  return calm ? LogLevel::notice : LogLevel::warning;
}

std::string figures(const WriteBlock& registers) {
  if (registers.state == State::starting || registers.q1_m >= kUnknownDistance) {
    return {};
  }
  std::string line = format_text("Q1 %.3f m, %u points matched", registers.q1_m, registers.matched);
  if (registers.age_ms < kUnknownAgeMs) {
    line += format_text(", pose %.0f ms old", registers.age_ms);
  }
  return line;
}

}  // namespace

std::string fault_words(Faults faults) {
  std::string words;
  for (const auto& [bit, name] : kFaultWords) {
    if ((faults & bit) != 0) {
      words += (words.empty() ? "" : ", ") + std::string(name);
    }
  }
  return words;
}

void StateLog::update(const WriteBlock& registers, const std::string& reason, SteadyTime now) {
  if (current_ != registers.state) {
    current_ = registers.state;
    current_since_ = now;
    ++unannounced_;
  }
  if (told_ == current_) {
    return;
  }
  const auto& last = last_line_[static_cast<std::size_t>(registers.state)];
  if (!last || now - *last >= kInterval || registers.state == State::stopped) {
    announce(registers, reason, now);
  }
}

void StateLog::announce(const WriteBlock& registers, const std::string& reason, SteadyTime now) {
  std::string line = format_text("state %s", state_name(registers.state));
  if (now - current_since_ >= kWorthTelling) {
    line += format_text(" for %.1f s,", to_seconds(now - current_since_));
  }
  if (told_) {
    line += format_text(" after %.1f s of %s", to_seconds(current_since_ - told_since_), state_name(*told_));
  }
  if (unannounced_ > 1) {
    line += " and " + counted(unannounced_ - 1, "change") + " in between";
  }
  for (const std::string& part :
       {figures(registers), fault_words(registers.faults), registers.health ? std::string{} : reason}) {
    if (!part.empty()) {
      line += "; " + part;
    }
  }
  sink_.write(level_of(registers.state), line + ". " + consequence(registers.state, registers.faults));
  told_ = registers.state;
  told_since_ = current_since_;
  unannounced_ = 0;
  last_line_[static_cast<std::size_t>(registers.state)] = now;
}

}  // namespace hulltrack
