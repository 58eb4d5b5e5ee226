#include "daemon/service/service.hpp"

#include <poll.h>
#include <unistd.h>

#include <array>
#include <cstdlib>
#include <exception>
#include <sstream>
#include <string>
#include <utility>

#include "core/base/text.hpp"
#include "daemon/pipeline/live_time.hpp"
#include "daemon/service/end_guard.hpp"
#include "daemon/service/farewell.hpp"
#include "daemon/service/summary.hpp"

namespace hulltrack {
namespace {

constexpr std::chrono::milliseconds kTurn{100};
constexpr Nanoseconds kStatusPeriod = std::chrono::seconds(1);
constexpr Nanoseconds kSummaryPeriod = std::chrono::minutes(1);
/// Of the 5 s of TimeoutStopSec= the log may need one for its last lines, twice half a second; another is
/// left for a busy computer.
constexpr Nanoseconds kEndPatience = std::chrono::seconds(3);

}  // namespace

namespace {

/// Why nothing on the quay can show a machine that is wrong from the start; empty if something can.
std::string missing_quay_witness(const Prepared& prepared) {
  const TrackerConfig& tracker = prepared.config.tracker;
  const QuayConfig& quay = tracker.quay;
  if (prepared.quay != nullptr || (quay.top_is_witness && quay.height && quay.slope && tracker.hull.region)) {
    return {};
  }
  std::string line =
      "no quay witness: of travel, slew, luff and mount only wrong signs and gross errors show. Set "
      "quay.map, or quay.height and quay.slope, see hulltrackd.toml(5)";
  if (!tracker.hull.region) {
    line += "; the two keys need hull.region";
  } else if (quay.top_is_witness) {
    line += "; the two keys are told here as soon as the quay's top was found in the scan";
  }
  return line;
}

}  // namespace

Service::Service(ServiceSetup setup, Signals& signals, SyslogSink& log)
    : setup_(std::move(setup)), signals_(signals), log_(log), restarts_(setup_.runtime_folder) {}

int Service::run() {
  if (const std::optional<int> ended = start()) {
    return *ended;
  }
  session_began_ = second_began_ = minute_began_ = steady_now();
  open_desk();
  notifier_.ready();
  while (!stopping_ && !failure_.get()) {
    wait();
    turn(steady_now());
  }
  const std::optional<std::string> failure = failure_.get();
  return failure ? end("stopped by a fault of its own: " + *failure, kExitFailed)
                 : end("stopped as asked", kExitStopped);
}

void Service::read_files(bool beside_session) {
  ReaderSetup reader = setup_.reader;
  reader.low_priority = beside_session;
  preparer_.emplace(setup_.config_file, reader, Preparer::Goal::run, steady_now());
  met_ = false;
}

void Service::start_session(const Prepared& prepared) {
  std::istringstream remarks(prepared.map_remark);
  for (std::string line; std::getline(remarks, line);) {
    log_.write(LogLevel::warning, line);
  }
  if (const std::string missing = missing_quay_witness(prepared); !missing.empty()) {
    log_.write(LogLevel::notice, missing);
  }
  session_ = std::make_unique<Session>(prepared, log_, on_failure(), registers_);
}

GuardedThread::OnFailure Service::on_failure() {
  return [this](const std::string& thread, const std::string& what) {
    failure_.put("thread " + thread + " failed: " + what);
  };
}

/// A service that cannot be asked for a reload is one all the same.
void Service::open_desk() {
  try {
    desk_.emplace(setup_.runtime_folder);
  } catch (const std::exception& error) {
    log_.write(LogLevel::warning,
               std::string("`hulltrackd --reload` will not work, only SIGHUP: ") + error.what());
  }
}

/// For a signal, for what the reader has to say, for somebody who asks, or a turn.
void Service::wait() const {
  std::array<pollfd, 3> entries{{{signals_.fd(), POLLIN, 0},
                                 {preparer_ ? preparer_->fd() : -1, POLLIN, 0},
                                 {desk_ ? desk_->fd() : -1, POLLIN, 0}}};
  poll(entries.data(), entries.size(), static_cast<int>(kTurn.count()));
}

void Service::take_signals() {
  for (ServiceSignal signal = signals_.next(); signal != ServiceSignal::none; signal = signals_.next()) {
    stopping_ = stopping_ || signal == ServiceSignal::stop;
    reload_asked_ = reload_asked_ || signal == ServiceSignal::reload;
  }
  reload_asked_ = (desk_ && desk_->take_requests()) || reload_asked_;
}

void Service::turn(SteadyTime now) {
  take_signals();
  if (stopping_) {
    return;
  }
  if (preparer_) {
    preparer_->step(now);
    if (preparer_->result()) {
      finish_reload();
    }
  } else if (reload_asked_) {
    begin_reload();
  }
  supervise(now);
  if (now - second_began_ >= kStatusPeriod) {
    report(now);
  }
}

int Service::end(const std::string& why, int code) {
  notifier_.stopping();
  const EndGuard guard(kEndPatience, [&log = log_, code] {
    log.write(LogLevel::error,
              "the end took too long: the PLC does not answer or a thread is stuck. The registers may still "
              "say health 1, and the PLC has to notice by the heartbeat that stands still");
    log.flush();
    std::_Exit(code);
  });
  desk_.reset();
  preparer_.reset();
  if (code == kExitStopped) {
    restarts_.end();
  }
  if (!plc_) {
    log_.write(LogLevel::error, why + "; the PLC could not be told, because [plc] is not known");
    return code;
  }
  const PlcWrite farewell = say_farewell();
  log_.write(code != kExitStopped || !farewell.ok() ? LogLevel::error : LogLevel::notice,
             why + "; " + farewell_words(farewell));
  return code;
}

/// By whoever talks to the PLC, else by nobody's leave: what stands in the registers, maybe health 1, must
/// not stay.
PlcWrite Service::say_farewell() {
  if (session_) {
    session_->end(Session::Ending::for_good);
    return session_->farewell();
  }
  if (stand_in_) {
    return stand_in_->say_farewell();
  }
  PlcClient client(*plc_, {}, registers_.heartbeat);
  return write_farewell(client,
                        registers_.publication.block({.stopped = true}, live_measurement_time(steady_now())));
}

void Service::begin_reload() {
  reload_asked_ = false;
  notifier_.reloading();
  log_.write(LogLevel::notice,
             "reload: reading " + setup_.config_file.string() + "; the old configuration stays in force");
  try {
    read_files(true);
  } catch (const std::exception& error) {
    refuse_reload({{setup_.config_file.string(), 0, error.what()}});
  }
}

void Service::finish_reload() {
  Preparation preparation = *std::move(preparer_->result());
  preparer_.reset();
  if (reload_asked_) {  // the files may have changed after they were read
    begin_reload();
  } else if (preparation.prepared) {
    swap_to(*std::move(preparation.prepared));
  } else {
    refuse_reload(preparation.problems);
  }
}

void Service::refuse_reload(const std::vector<Problem>& problems) {
  std::string lines;
  for (const Problem& problem : problems) {
    log_.write(LogLevel::error, to_string(problem));
    lines += to_string(problem) + '\n';
  }
  const std::string verdict =
      "reload refused: the old configuration stays in force. Mend the lines above, then reload again";
  log_.write(LogLevel::error, verdict);
  tell_of_reload(false, lines + verdict);
}

/// Whoever has asked, and the service manager.
void Service::tell_of_reload(bool reloaded, const std::string& text) {
  if (desk_) {
    desk_->answer(reloaded, text + '\n');
  }
  notifier_.ready();
}

void Service::swap_to(Prepared next) {
  registers_ = session_->end(Session::Ending::for_reload);
  session_.reset();
  try {
    start_session(next);
    prepared_ = std::move(next);
    plc_ = prepared_.config.plc;
    log_.apply(prepared_.config.log);
    const std::string verdict = "reload: the new configuration is in force; the hull is searched for again";
    log_.write(LogLevel::notice, verdict);
    tell_of_reload(true, verdict);
  } catch (const std::exception& refusal) {
    fall_back(refusal.what());
  }
}

void Service::fall_back(const std::string& refusal) {
  try {
    start_session(prepared_);
    const std::string verdict = "reload refused: " + refusal + ". The old configuration stays in force";
    log_.write(LogLevel::error, verdict);
    tell_of_reload(false, verdict);
  } catch (const std::exception&) {
    log_.write(LogLevel::error, "reload failed: " + refusal +
                                    ". The old configuration cannot go on either; " +
                                    farewell_words(say_farewell()));
    throw;
  }
}

void Service::supervise(SteadyTime now) {
  const std::vector<ThreadWatch::Overdue> overdue = session_->watch().overdue(now);
  if (overdue.empty()) {
    notifier_.watchdog(now);
  }
  progress_log_.update(overdue, now);
}

void Service::report(SteadyTime now) {
  const Figures second = session_->take_figures();
  const WriteBlock registers = session_->registers();
  notifier_.status(status_line(registers, second, now - second_began_));
  second_began_ = now;
  if (now - session_began_ >= kGoodSpell && !std::exchange(good_spell_told_, true)) {
    restarts_.forget();
  }
  minute_.add(second);
  if (now - minute_began_ >= kSummaryPeriod) {
    log_.write(LogLevel::info, summary_line(registers, minute_, now - minute_began_));
    log_.write(LogLevel::info, hull_line(minute_.hull, now));
    minute_ = {};
    minute_began_ = now;
  }
}

}  // namespace hulltrack
