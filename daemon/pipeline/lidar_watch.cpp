#include "daemon/pipeline/lidar_watch.hpp"

#include <algorithm>
#include <cmath>

#include "core/base/text.hpp"
#include "daemon/pipeline/live_time.hpp"
#include "daemon/pipeline/standing.hpp"
#include "lidar_drivers/model_registry.hpp"

namespace hulltrack {
namespace {

/// Lost packets below this share are left to the minute's summary.
constexpr double kWorthyLoss = 0.005;
/// A motor holds its speed within a few rpm; beyond this share it was set to something else.
constexpr double kRateTolerance = 0.05;
/// A sensor tells its lasers' angles about once a second.
constexpr std::chrono::seconds kLongestUntold{3};

std::string clock_remedy(const ClockReading& clock, const std::string& name) {
  const LidarModel* model = find_lidar_model(name);
  if (clock.reference != ClockReference::none || model == nullptr) return "Check its time synchronisation";
  std::string by(model->clock_by);
  if (const auto comma = by.find(", "); comma != std::string::npos) by.replace(comma, 2, " or ");
  std::string remedy = "Set up " + by + " on it";
  if (model->calibration == LidarModel::Calibration::required)
    remedy += " and fetch its " + std::string(model->calibration_file) + " again, which says so";
  return remedy;
}

}  // namespace

LidarWatch::LidarWatch(const LidarConfig& config, double expected_rpm, LogSink& log, SteadyTime start)
    : config_(config),
      name_("LiDAR " + config.name),
      expected_rpm_(expected_rpm),
      start_(start),
      silence_log_(log, LogLevel::error),
      foreign_log_(log),
      rejected_log_(log),
      held_back_log_(log),
      overflow_log_(log),
      loss_log_(log),
      rate_log_(log),
      mode_log_(log, LogLevel::notice),
      sector_log_(log, LogLevel::info),
      clock_log_(log),
      another_log_(log, LogLevel::error),
      filtered_log_(log) {}

Faults LidarWatch::update(const LidarCounters& counters, SteadyTime now) {
  update_silence(counters, now);
  update_refused(counters, now);
  update_quality(counters, now);
  return standing_of(counters.status, silent_);
}

void LidarWatch::update_silence(const LidarCounters& counters, SteadyTime now) {
  const Nanoseconds silence =
      silence_of(counters.status, live_measurement_time(start_), live_measurement_time(now));
  silent_ = silence > config_.timeout;
  silence_log_.update(
      silent_, now,
      [&] {
        return format_text(
            "%s: no usable packet on UDP port %u for %.1f s; health is 0 until it is back. Check its power, "
            "its cable, that it sends to this computer and that a firewall lets it through",
            name_.c_str(), config_.port, to_seconds(silence));
      },
      [&](Nanoseconds lasted) {
        return format_text("%s: packets again after %.1f s", name_.c_str(),
                           to_seconds(lasted + config_.timeout));
      });
}

template <std::invocable Entry>
void LidarWatch::tell(ConditionLog& log, bool active, SteadyTime now, Entry&& entry, const char* end) {
  log.update(
      active, now, [&] { return name_ + ": " + entry(); }, [&](Nanoseconds) { return name_ + ": " + end; });
}

void LidarWatch::update_refused(const LidarCounters& counters, SteadyTime now) {
  tell(
      foreign_log_, foreign_grows_.update(counters.foreign, now), now,
      [&] {
        return format_text(
            "dropped datagrams from %s, which is not the configured source %s; %llu so far. Poses are not "
            "affected; find out who sends to UDP port %u",
            counters.last_foreign.c_str(), config_.source.c_str(),
            static_cast<unsigned long long>(counters.foreign), config_.port);
      },
      "no more datagrams from foreign senders");
  tell(
      another_log_, another_grows_.update(counters.status.packets_of_another, now), now,
      [&] {
        return counters.two_senders + "; set `source` to the one that is meant. " +
               (counters.status.disputed ? "Nobody can say which that is, so health is 0 until one is alone"
                                         : "The first goes on alone, the other's datagrams are dropped");
      },
      "one sensor alone sends to its port again");
  tell(
      filtered_log_, filtered_grows_.update(counters.filtered, now), now,
      [&] {
        return format_text(
            "a packet filter of this computer has kept %s from UDP port %u, IPAddressDeny= of the unit for "
            "one: somebody who is not named in IPAddressAllow= sends there. Poses are not affected",
            counted(counters.filtered, "datagram").c_str(), config_.port);
      },
      "no packet filter is at work any more");
  tell(
      rejected_log_, rejected_grows_.update(counters.status.packets_rejected, now), now,
      [&] {
        return format_text(
            "dropped datagrams that are not those of a %s: %s; %llu so far. Compare `model` and `port` in "
            "the configuration with the sensor",
            config_.model.c_str(), counters.last_rejection.c_str(),
            static_cast<unsigned long long>(counters.status.packets_rejected));
      },
      "no more malformed datagrams");
  const bool held_back = held_back_grows_.update(counters.status.packets_held_back, now);
  const bool contradicted = counters.status.angles_contradicted;
  tell(
      held_back_log_, held_back && (contradicted || now - start_ > kLongestUntold), now,
      [&] {
        if (contradicted) {
          return std::string(
              "its data are held back, since what it tells of its lasers' angles contradicts itself. If this "
              "lasts, two sensors send to one port: set `source`; or `calibration` is another sensor's");
        }
        const std::string port = config_.information_port == 0
                                     ? "`information_port` is 0"
                                     : format_text(
                                           "it sends them once a second to UDP port %u "
                                           "(`information_port`): let that port through",
                                           config_.information_port);
        return "its data are held back, since it has not told its lasers' angles; " + port +
               ", or give `calibration`";
      },
      "it has told its lasers' angles");
  tell(
      overflow_log_, overflow_grows_.update(counters.kernel_overflows, now), now,
      [&] {
        return format_text(
            "the kernel's receive buffer overflowed, %s lost so far. Is this computer overloaded? See "
            "net.core.rmem_max in hulltrackd(8)",
            counted(counters.kernel_overflows, "packet").c_str());
      },
      "the receive buffer does not overflow any more");
}

void LidarWatch::update_quality(const LidarCounters& counters, SteadyTime now) {
  const LidarStatus& status = counters.status;
  tell(
      loss_log_, !silent_ && status.loss > kWorthyLoss, now,
      [&] {
        return format_text(
            "%.1f %% of its packets get lost on the way. Check cable, switch and this computer's load",
            100.0 * status.loss);
      },
      "no packets get lost any more");
  const bool turning = !silent_ && status.rpm > 0.0;
  tell(
      rate_log_, turning && std::abs(status.rpm - expected_rpm_) > kRateTolerance * expected_rpm_, now,
      [&] {
        return format_text("turns at %.0f rpm where frame_rate_hz asks for %.0f, so a frame is not one turn",
                           status.rpm, expected_rpm_);
      },
      "no wrong rotation rate any more");
  tell(
      mode_log_, mode_changes_.update(status.return_mode_changes, now), now,
      [&] {
        return format_text(
            "its return mode was changed to %s, %s so far. If nobody meant that, set it in its web page",
            return_mode_name(status.return_mode), counted(status.return_mode_changes, "time").c_str());
      },
      "its return mode stays as it is");
  tell(
      sector_log_, status.field_of_view_cut, now,
      [] {
        return std::string(
            "it leaves sectors out. If that is not meant, set its field of view to 360 deg in its web page");
      },
      "it leaves no sector out");
  tell(
      clock_log_, status.clock_fault, now,
      [&] {
        return "its clock is " + clock_words(status.clock) + "; the time of reception is used instead. " +
               clock_remedy(status.clock, config_.model);
      },
      "its clock agrees again");
}

}  // namespace hulltrack
