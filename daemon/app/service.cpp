#include "daemon/app/service.hpp"

#include <poll.h>

#include <exception>
#include <utility>

#include "core/base/text.hpp"
#include "daemon/app/farewell.hpp"
#include "daemon/app/live_time.hpp"
#include "daemon/app/summary.hpp"

namespace hulltrack {
namespace {

constexpr std::chrono::milliseconds kTurn{100};
constexpr Nanoseconds kStatusPeriod = std::chrono::seconds(1);
constexpr Nanoseconds kSummaryPeriod = std::chrono::minutes(1);

void wait_for_signal(const Signals& signals) {
  pollfd entry{signals.fd(), POLLIN, 0};
  poll(&entry, 1, static_cast<int>(kTurn.count()));
}

}  // namespace

Service::Service(std::filesystem::path config_file, Prepared prepared, Signals& signals, SyslogSink& log)
    : config_file_(std::move(config_file)), prepared_(std::move(prepared)), signals_(signals), log_(log) {}

int Service::run() {
  start_session(prepared_);
  second_began_ = minute_began_ = steady_now();
  const Config& config = prepared_.config;
  log_.write(
      LogLevel::notice,
      format_text("started: %s, map %s with %s, PLC %s:%u", counted(config.lidars.size(), "LiDAR").c_str(),
                  config.map_file.c_str(), counted(prepared_.map->cloud_H().size(), "point").c_str(),
                  config.plc.host.c_str(), config.plc.port));
  notifier_.ready();
  while (!stopping_ && !failure_.get()) {
    wait_for_signal(signals_);
    turn(steady_now());
  }
  notifier_.stopping();
  session_->end(Session::Ending::for_good);
  const std::optional<std::string> failure = failure_.get();
  const PlcWrite& farewell = session_->farewell();
  log_.write(failure || !farewell.ok() ? LogLevel::error : LogLevel::notice,
             (failure ? "stopped by a fault of its own: " + *failure : "stopped as asked") + "; " +
                 farewell_words(farewell));
  return failure ? 1 : 0;
}

void Service::start_session(const Prepared& prepared) {
  if (!prepared.map_remark.empty()) {
    log_.write(LogLevel::warning, prepared.map_remark);
  }
  session_ = std::make_unique<Session>(
      prepared, log_,
      [this](const std::string& thread, const std::string& what) {
        failure_.put("thread " + thread + " failed: " + what);
      },
      registers_);
}

void Service::turn(SteadyTime now) {
  for (ServiceSignal signal = signals_.next(); signal != ServiceSignal::none; signal = signals_.next()) {
    if (signal == ServiceSignal::stop) {
      stopping_ = true;
      return;
    }
    begin_reload();
  }
  if (reload_.valid() && reload_.wait_for(std::chrono::seconds(0)) == std::future_status::ready) {
    finish_reload();
  }
  supervise(now);
  if (now - second_began_ >= kStatusPeriod) {
    report(now);
  }
}

void Service::begin_reload() {
  if (reload_.valid()) {
    reload_again_ = true;  // the files may have changed after they were read
    return;
  }
  notifier_.reloading();
  log_.write(LogLevel::notice,
             "reload: reading " + config_file_.string() + "; the old configuration stays in force");
  reload_ = std::async(std::launch::async, [file = config_file_] { return prepare(file); });
}

void Service::finish_reload() {
  Preparation preparation = reload_.get();
  if (std::exchange(reload_again_, false)) {
    begin_reload();
    return;
  }
  if (preparation.prepared) {
    swap_to(std::move(*preparation.prepared));
  } else {
    for (const Problem& problem : preparation.problems) {
      log_.write(LogLevel::error, to_string(problem));
    }
    log_.write(LogLevel::error,
               "reload refused: the old configuration stays in force. Mend the lines above, then "
               "reload again");
  }
  notifier_.ready();
}

void Service::swap_to(Prepared next) {
  registers_ = session_->end(Session::Ending::for_reload);
  session_.reset();
  try {
    start_session(next);
    prepared_ = std::move(next);
    log_.apply(prepared_.config.log);
    log_.write(LogLevel::notice, "reload: the new configuration is in force; the hull is searched for again");
  } catch (const std::exception& refusal) {
    fall_back(refusal.what());
  }
}

void Service::fall_back(const std::string& refusal) {
  try {
    start_session(prepared_);
    log_.write(LogLevel::error, "reload refused: " + refusal + ". The old configuration stays in force");
  } catch (const std::exception&) {
    log_.write(LogLevel::error, "reload failed: " + refusal +
                                    ". The old configuration cannot go on either; " +
                                    farewell_words(say_farewell()));
    throw;
  }
}

/// Without a plc thread: what the last session left in the registers, maybe health 1, must not stand.
PlcWrite Service::say_farewell() {
  PlcClient client(prepared_.config.plc, {}, registers_.heartbeat);
  return write_farewell(client, registers_.publication.block({.stopped = true}, steady_now()));
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
  minute_.add(second);
  if (now - minute_began_ >= kSummaryPeriod) {
    log_.write(LogLevel::info, summary_line(registers, minute_, now - minute_began_));
    log_.write(LogLevel::info, hull_line(minute_.hull, now));
    minute_ = {};
    minute_began_ = now;
  }
}

}  // namespace hulltrack
