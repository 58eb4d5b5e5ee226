#include "daemon/service/summary.hpp"

#include <cmath>

#include "core/base/text.hpp"

namespace hulltrack {
namespace {

double percent(std::uint64_t part, std::uint64_t whole) {
  return whole > 0 ? 100.0 * static_cast<double>(part) / static_cast<double>(whole) : 0.0;
}

double per_second(std::uint64_t count, Nanoseconds window) {
  return static_cast<double>(count) / to_seconds(window);
}

double loss_percent(const Figures& figures) {
  return percent(figures.packets_lost, figures.packets + figures.packets_lost);
}

std::string q1_words(const Figures& figures) {
  return figures.q1_m.count > 0 ? format_text("Q1 %.3f m", figures.q1_m.mean()) : "no Q1";
}

std::string plc_words(const WriteBlock& registers, const Figures& figures) {
  if (figures.round_trip_ms.count == 0) {
    return "PLC down";
  }
  const bool stale = (registers.faults & fault::plc_stale) != 0;
  const bool doubtful = (registers.faults & fault::plc_value) != 0;
  return format_text("PLC %.1f ms%s%s%s", figures.round_trip_ms.mean(), stale ? " but its data stale" : "",
                     doubtful ? " but its joint values not believed" : "",
                     figures.writes_failed > 0 ? " but writes fail" : "");
}

std::string lidar_words(const WriteBlock& registers, const Figures& figures) {
  const bool silent = (registers.faults & fault::lidar_silent) != 0;
  return format_text("loss %.1f %%%s", loss_percent(figures), silent ? ", LiDAR silent" : "");
}

constexpr double kHour = 3600.0;  // s
constexpr double kMinute = 60.0;  // s

/// ", sinking 1.1 m/h", or ", steady" where that rounds to nothing.
std::string hourly(double an_hour, const char* up, const char* down, const char* unit) {
  if (std::abs(an_hour) < 0.05) {
    return ", steady";
  }
  return format_text(", %s %.1f %s", an_hour > 0.0 ? up : down, std::abs(an_hour), unit);
}

std::string lean_rate(double lean, const std::optional<double>& rate) {
  return rate ? hourly(std::copysign(degrees(*rate), lean * *rate) * kHour, "growing", "easing", "deg/h")
              : "";
}

std::string draft_words(const ShipMotion& now, const std::optional<ShipMotion>& rate) {
  return format_text("%.2f m %s", std::abs(now.draft), now.draft >= 0.0 ? "deeper" : "higher") +
         (rate ? hourly(rate->draft * kHour, "sinking", "rising", "m/h") : "");
}

std::string heel_words(const ShipMotion& now, const std::optional<ShipMotion>& rate) {
  return format_text("heel %.2f deg, %s side down", std::abs(degrees(now.heel)),
                     now.heel >= 0.0 ? "-Y" : "+Y") +
         lean_rate(now.heel, rate ? std::optional(rate->heel) : std::nullopt);
}

std::string trim_words(const ShipMotion& now, const std::optional<ShipMotion>& rate, double length) {
  return format_text("trim %.2f deg (%.2f m over %.0f m), %s end down", std::abs(degrees(now.trim)),
                     std::abs(std::tan(now.trim)) * length, length, now.trim >= 0.0 ? "+X" : "-X") +
         lean_rate(now.trim, rate ? std::optional(rate->trim) : std::nullopt);
}

std::string surge_words(const ShipMotion& now, const std::optional<ShipMotion>& rate) {
  return format_text("surge %+.2f m", now.surge) +
         (rate ? format_text(", %+.2f m/min", rate->surge * kMinute) : "");
}

}  // namespace

std::string status_line(const WriteBlock& registers, const Figures& figures, Nanoseconds window) {
  return format_text("%s %.1f Hz, %s, %s, %s", state_name(registers.state),
                     per_second(figures.frames, window), q1_words(figures).c_str(),
                     plc_words(registers, figures).c_str(), lidar_words(registers, figures).c_str());
}

std::string summary_line(const WriteBlock& registers, const Figures& figures, Nanoseconds window) {
  std::string line =
      format_text("last %.0f s: %s; %s (%.1f Hz), health 1 in %.1f %%, %s, latency %.0f ms (worst %.0f)",
                  to_seconds(window), state_name(registers.state), counted(figures.frames, "frame").c_str(),
                  per_second(figures.frames, window), percent(figures.healthy_frames, figures.frames),
                  q1_words(figures).c_str(), figures.latency_ms.mean(), figures.latency_ms.worst);
  line += format_text(", computing %.1f ms (worst %.1f), %s dropped", figures.processing_ms.mean(),
                      figures.processing_ms.worst, counted(figures.frames_dropped, "frame").c_str());
  line += format_text(
      "; %s (worst %.1f), %llu of %llu polls and %s failed, longest gap between writes %.0f ms",
      plc_words(registers, figures).c_str(), figures.round_trip_ms.worst,
      static_cast<unsigned long long>(figures.polls_failed), static_cast<unsigned long long>(figures.polls),
      counted(figures.writes_failed, "write").c_str(), figures.write_gap_ms.worst);
  line += format_text("; %s, %s, %llu refused", counted(figures.packets, "packet").c_str(),
                      lidar_words(registers, figures).c_str(),
                      static_cast<unsigned long long>(figures.packets_refused));
  return line;
}

std::string hull_line(const std::optional<HullFigures>& hull, SteadyTime now) {
  if (!hull || !hull->motion.now) {
    return "hull: no healthy pose, so neither draft nor heel, trim and surge are known";
  }
  const MotionProducts& motion = hull->motion;
  std::string line = "hull since its map";
  if (const double age = to_seconds(now - hull->when); age >= 1.0) {
    line += format_text(", as it lay %.0f s ago when health was last 1", age);
  }
  line += ": " + draft_words(*motion.now, motion.rate) + "; " + heel_words(*motion.now, motion.rate) + "; " +
          trim_words(*motion.now, motion.rate, motion.mapped_length) + "; " +
          surge_words(*motion.now, motion.rate);
  if (hull->sigma_bend >= 0.0) {
    line += format_text("; %s %.2f m (1 sigma %.2f m)", hull->bend >= 0.0 ? "sag" : "hog",
                        std::abs(hull->bend), hull->sigma_bend);
  }
  return line + (motion.rate ? "" : "; rates not known yet");
}

}  // namespace hulltrack
