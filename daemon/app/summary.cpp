#include "daemon/app/summary.hpp"

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
  return format_text("PLC %.1f ms%s%s", figures.round_trip_ms.mean(), stale ? " but its data stale" : "",
                     figures.writes_failed > 0 ? " but writes fail" : "");
}

std::string lidar_words(const WriteBlock& registers, const Figures& figures) {
  const bool silent = (registers.faults & fault::lidar_silent) != 0;
  return format_text("loss %.1f %%%s", loss_percent(figures), silent ? ", LiDAR silent" : "");
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

}  // namespace hulltrack
