// What did a replay come to? States, reasons, figures and, where the truth is known, errors.
//
// Errors are taken at the middle of each frame, the truth interpolated linearly: translation of the
// reference point (m), angle between the rotations (deg). Pure; the caller prints.
// Cost: tens of bytes a frame.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "core/io/plc_csv.hpp"
#include "core/tracking/hull_tracker.hpp"
#include "daemon/replay/reason_table.hpp"

namespace hulltrack {

/// An error beyond these is no bad luck with noise, whatever the ship does.
inline constexpr double kGrossError = 0.10;   // m
inline constexpr double kGrossTurnDeg = 0.3;  // deg

/// Displacement and rotation of the truth at `t`, or nothing outside its table.
[[nodiscard]] std::optional<TruthRow> truth_at(const std::vector<TruthRow>& truth, std::int64_t t_ns);

class ReplaySummary {
 public:
  /// `truth` may be empty: no errors then.
  ReplaySummary(std::vector<TruthRow> truth, double max_speed);

  void add(const TrackResult& result, double processing_ms);
  [[nodiscard]] bool empty() const { return frames_.empty(); }

  /// Lines for the terminal. `with_timing` false leaves the processing times out.
  [[nodiscard]] std::string text(bool with_timing) const;

 private:
  struct Frame {
    std::uint32_t number;
    std::int64_t t_ns;
    State state;
    bool registered;
    bool converged;
    int iterations;
    double q1;           // m, -1 without metrics
    double q1_expected;  // m, -1 where it cannot be told
    double ms;
    double error = -1.0;     // m, -1 = unknown
    double turn_deg = -1.0;  // deg
    bool moving = false;     // the truth's slope over the last second is above max_speed
  };

  [[nodiscard]] std::string states_text() const;
  [[nodiscard]] std::string figures_text(bool with_timing) const;
  [[nodiscard]] std::string errors_text() const;
  [[nodiscard]] std::string reaction_text() const;

  std::vector<TruthRow> truth_;
  double max_speed_;
  std::vector<Frame> frames_;
  ReasonTable reasons_;
  std::optional<SeenTop> found_top_;
};

}  // namespace hulltrack
