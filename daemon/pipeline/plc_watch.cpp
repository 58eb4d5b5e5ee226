#include "daemon/pipeline/plc_watch.hpp"

#include <utility>

#include "core/base/text.hpp"
#include "daemon/pipeline/live_time.hpp"

namespace hulltrack {
namespace {

bool link_broken(LinkOutcome outcome) {
  return outcome != LinkOutcome::ok && outcome != LinkOutcome::exception && outcome != LinkOutcome::waiting;
}

}  // namespace

PlcWatch::PlcWatch(const PlcConfig& config, LogSink& log, SteadyTime start)
    : config_(config),
      name_("PLC " + config.host + ":" + std::to_string(config.port)),
      news_(config, live_measurement_time(start)),
      link_log_(log, LogLevel::error),
      read_log_(log, LogLevel::error),
      write_log_(log, LogLevel::error),
      stale_log_(log),
      value_log_(log),
      wait_log_(log),
      overwritten_log_(log, LogLevel::error) {}

void PlcWatch::update_link(LinkOutcome outcome, const std::string& message, SteadyTime now) {
  if (link_broken(outcome)) {
    link_was_lost_ = true;
    link_up_ = false;
    link_message_ = message;
  } else if (outcome != LinkOutcome::waiting) {
    link_up_ = true;
  }
  link_log_.update(
      !link_up_ && link_was_lost_, now,
      [&] {
        return format_text(
            "%s: %s. It gets no pose meanwhile and must stop trusting the last one by its own timer; "
            "trying again by itself. Check the PLC, the cable and IPAddressAllow= of the unit",
            name_.c_str(), link_message_.c_str());
      },
      [&](Nanoseconds lasted) {
        return format_text("%s: connected again after %.1f s", name_.c_str(), to_seconds(lasted));
      });
}

void PlcWatch::polled(const PlcPoll& poll, SteadyTime now) {
  update_link(poll.outcome, poll.message, now);
  if (poll.outcome != LinkOutcome::waiting) {
    const bool refused = poll.outcome == LinkOutcome::exception;
    refusal_ = refused ? poll.message : std::string{};
    read_log_.update(
        refused && poll.exception != kExceptionBusy, now,
        [&] {
          return format_text("%s refuses to be read, so no scan has joints: %s", name_.c_str(),
                             poll.message.c_str());
        },
        [&](Nanoseconds) { return name_ + ": can be read again"; });
  }
  if (poll.ok() && poll.fresh) {
    news_.heard(live_measurement_time(poll.stamp()));
  }
}

void PlcWatch::judged(const JointGate::Outcome& outcome, SteadyTime now) {
  value_fault_ = outcome.faults;
  const bool refused = outcome.verdict == JointGate::Verdict::refused;
  value_log_.update(
      value_fault_ != 0 && (refused || value_log_.active()), now,
      [&] {
        return format_text("%s: joint value refused, scans are not registered with it: %s", name_.c_str(),
                           outcome.reason.c_str());
      },
      [&](Nanoseconds lasted) {
        return format_text("%s: joint values are good again after %.1f s", name_.c_str(), to_seconds(lasted));
      });
  wait_log_.update(
      outcome.needs_edge, now,
      [&] {
        return format_text(
            "%s: %s. Health is 0 until then: check that travel, slew and luff are right, then %s",
            name_.c_str(), outcome.reason.c_str(),
            config_.read.command >= 0 ? "set command bit 1 until the echo shows it" : "restart the service");
      },
      [&](Nanoseconds lasted) {
        return format_text("%s: joint values are believed again after a wait of %.1f s", name_.c_str(),
                           to_seconds(lasted));
      });
}

void PlcWatch::wrote(const PlcWrite& write, SteadyTime now) {
  update_link(write.outcome, write.message, now);
  if (write.outcome != LinkOutcome::waiting) {
    write_log_.update(
        write.outcome == LinkOutcome::exception, now,
        [&] {
          return format_text("%s refuses our registers, so it sees our heartbeat stop: %s", name_.c_str(),
                             write.message.c_str());
        },
        [&](Nanoseconds) { return name_ + ": takes our registers again"; });
  }
  if (write.ok()) {
    link_was_lost_ = false;
  }
  if (write.read_back != ReadBack::not_due) {
    overwritten_log_.update(
        write.read_back == ReadBack::overwritten, now, [&] { return name_ + ": " + write.read_back_message; },
        [&](Nanoseconds) { return name_ + ": our registers stay as we wrote them again"; });
  }
}

Faults PlcWatch::standing(SteadyTime now) {
  const bool stale = news_.is_stale(live_measurement_time(now));
  stale_log_.update(
      stale, now,
      [&] {
        return format_text("%s: no new joint values for %.1f s, so no new pose; %s", name_.c_str(),
                           to_seconds(news_.silence(live_measurement_time(now))),
                           !link_up_          ? "the link is down"
                           : refusal_.empty() ? "its heartbeat does not move: is its program running?"
                                              : refusal_.c_str());
      },
      [&](Nanoseconds) { return name_ + ": new joint values again"; });
  return static_cast<Faults>(value_fault_ | (stale ? fault::plc_stale : 0));
}

}  // namespace hulltrack
