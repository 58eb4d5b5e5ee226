// The service from its start to its first session: the PLC first, then the files (service.hpp).
#include <exception>
#include <utility>

#include "core/base/text.hpp"
#include "daemon/pipeline/live_time.hpp"
#include "daemon/service/farewell.hpp"
#include "daemon/service/service.hpp"

namespace hulltrack {
namespace {

std::string words_of(const RestartRecord::Verdict& before) {
  const std::string last = before.last_end.empty() ? "" : " (the last end: " + before.last_end + ")";
  return format_text(
      "failed %d times in a row%s, never at work for a minute: trying again in %.0f s, or on SIGHUP; until "
      "then "
      "the PLC sees health 0, state fault. The lines before each end say why",
      before.failures, last.c_str(), to_seconds(before.pause));
}

}  // namespace

/// Nothing once a session runs, else the exit code.
std::optional<int> Service::start() {
  if (const std::optional<int> ended = wait_after_failures(restarts_.begin())) {
    return ended;
  }
  read_files(false);
  while (!preparer_->result()) {
    if (const std::optional<int> ended = turn_without_session()) {
      return ended;
    }
    if (std::exchange(reload_asked_, false)) {
      read_files(false);
    }
  }
  Preparation preparation = *std::move(preparer_->result());
  preparer_.reset();
  if (!preparation.prepared) {
    return give_up(preparation);
  }
  start_first_session(*std::move(preparation.prepared));
  return std::nullopt;
}

/// While [plc] is as good as it is going to be: with a reading of its own, which nothing else is taken from.
std::optional<int> Service::wait_after_failures(const RestartRecord::Verdict& before) {
  const SteadyTime until = steady_now() + before.pause;
  if (before.pause == Nanoseconds{0}) {
    return std::nullopt;
  }
  waiting_ = true;
  bool told = false;
  try {
    read_files(false);
  } catch (const std::exception& error) {
    log_.write(LogLevel::error, error.what());
  }
  while (!std::exchange(reload_asked_, false) && steady_now() < until) {
    if (const std::optional<int> ended = turn_without_session()) {
      return ended;
    }
    if (preparer_ && (preparer_->configuration() || preparer_->result())) {
      preparer_.reset();
    }
    if (!preparer_ && !std::exchange(told, true)) {
      log_.write(LogLevel::error, words_of(before));
    }
  }
  if (!told) {
    log_.write(LogLevel::error, words_of(before));
  }
  preparer_.reset();
  waiting_ = false;
  return std::nullopt;
}

/// The exit code if that was the last one.
std::optional<int> Service::turn_without_session() {
  wait();
  take_signals();
  if (const std::optional<std::string> failure = failure_.get()) {
    return end("stopped by a fault of its own: " + *failure, kExitFailed);
  }
  if (stopping_) {
    return end("stopped as asked, before it was ready", kExitStopped);
  }
  const SteadyTime now = steady_now();
  if (preparer_) {
    preparer_->step(now);
    meet_plc();
  }
  if (!stand_in_ || stand_in_->watch().overdue(now).empty()) {
    notifier_.starting(now);
  }
  notifier_.status(waiting_ ? "waits after failures in a row, the log says for how long; health 0"
                            : "starts: files are being read; health 0");
  return std::nullopt;
}

/// Once for each reading, whose [plc] may be another.
void Service::meet_plc() {
  const std::optional<ConfigReading>& reading = preparer_->configuration();
  if (!reading || std::exchange(met_, true)) {
    return;
  }
  log_.apply(reading->readable.log);
  if (!reading->plc) {
    return;
  }
  plc_ = reading->plc;
  hand_over_registers();
  stand_in_ = std::make_unique<PlcStandIn>(
      *plc_, waiting_ ? PlcStandIn::Meaning::waiting : PlcStandIn::Meaning::starting, log_, on_failure(),
      registers_);
}

void Service::hand_over_registers() {
  if (stand_in_) {
    registers_ = stand_in_->hand_over();
    stand_in_.reset();
  }
}

int Service::give_up(const Preparation& preparation) {
  problems_ = preparation.problems;
  return end("not started: " + counted(problems_.size(), "problem") + " with " + setup_.config_file.string() +
                 " or the files that it names, told on standard error",
             preparation.may_pass ? kExitFailed : kExitConfig);
}

void Service::start_first_session(Prepared prepared) {
  plc_ = prepared.config.plc;
  log_.apply(prepared.config.log);
  hand_over_registers();
  try {
    start_session(prepared);
  } catch (const std::exception&) {
    log_.write(LogLevel::error, "not started; " + farewell_words(say_farewell()));
    throw;
  }
  prepared_ = std::move(prepared);
  const Config& config = prepared_.config;
  log_.write(
      LogLevel::notice,
      format_text("started: %s, map %s with %s, PLC %s:%u", counted(config.lidars.size(), "LiDAR").c_str(),
                  config.map_file.c_str(), counted(prepared_.map_points, "point").c_str(),
                  config.plc.host.c_str(), config.plc.port));
}

}  // namespace hulltrack
