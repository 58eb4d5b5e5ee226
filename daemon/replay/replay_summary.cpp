#include "daemon/replay/replay_summary.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "core/base/percentile.hpp"
#include "core/base/text.hpp"
#include "core/geometry/health_contract.hpp"
#include "daemon/pipeline/found_top.hpp"

namespace hulltrack {
namespace {

constexpr std::int64_t kSecond = 1'000'000'000;

bool healthy(State state) { return state == State::tracking; }

double largest(const std::vector<double>& values) {
  return values.empty() ? 0.0 : *std::max_element(values.begin(), values.end());
}

double root_mean_square(const std::vector<double>& values) {
  double squares = 0.0;
  for (const double v : values) {
    squares += v * v;
  }
  return values.empty() ? 0.0 : std::sqrt(squares / static_cast<double>(values.size()));
}

Eigen::Matrix3d rotation_of(const TruthRow& row) {
  return rotation_from_rpy(row.rpy_deg * (std::numbers::pi / 180.0));
}

/// Least squares slope of the truth over the second before t, m/s.
double truth_speed(const std::vector<TruthRow>& truth, std::int64_t t_ns) {
  constexpr int kSteps = 20;
  Eigen::Vector3d slope = Eigen::Vector3d::Zero();
  double squares = 0.0;
  for (int i = 0; i <= kSteps; ++i) {
    const double t = static_cast<double>(i) / kSteps - 0.5;
    const auto row = truth_at(truth, t_ns - kSecond + i * (kSecond / kSteps));
    if (!row) {
      return 0.0;
    }
    slope += t * row->xyz;
    squares += t * t;
  }
  return (slope / squares).norm();
}

}  // namespace

std::optional<TruthRow> truth_at(const std::vector<TruthRow>& truth, std::int64_t t_ns) {
  const auto after = std::lower_bound(truth.begin(), truth.end(), t_ns,
                                      [](const TruthRow& row, std::int64_t t) { return row.t_ns < t; });
  if (after == truth.end()) {
    return std::nullopt;
  }
  if (after->t_ns == t_ns) {
    return *after;
  }
  if (after == truth.begin()) {
    return std::nullopt;
  }
  const TruthRow& a = *std::prev(after);
  const double w = static_cast<double>(t_ns - a.t_ns) / static_cast<double>(after->t_ns - a.t_ns);
  return TruthRow{t_ns, a.xyz + w * (after->xyz - a.xyz), a.rpy_deg + w * (after->rpy_deg - a.rpy_deg)};
}

ReplaySummary::ReplaySummary(std::vector<TruthRow> truth, double max_speed)
    : truth_(std::move(truth)), max_speed_(max_speed) {}

void ReplaySummary::add(const TrackResult& r, double processing_ms) {
  Frame frame{r.frame,
              to_ns(r.time),
              r.state,
              r.registered,
              r.converged,
              r.iterations,
              r.metrics.valid ? r.metrics.q1 : -1.0,
              r.metrics.q1_expected.value_or(-1.0),
              processing_ms};
  if (const auto truth = truth_at(truth_, frame.t_ns)) {
    frame.moving = truth_speed(truth_, frame.t_ns) > max_speed_;
    if (r.registered) {
      frame.error = (r.pose.displacement() - truth->xyz).norm();
      frame.turn_deg = degrees(rotation_angle(rotation_of(*truth).transpose() * r.pose.rotation()));
    }
  }
  frames_.push_back(frame);
  if (!r.health) {
    reasons_.add(r.frame, r.reason);
  }
  found_top_ = r.found_top ? r.found_top : found_top_;
}

std::string ReplaySummary::text(bool with_timing) const {
  if (empty()) {
    return "no frames\n";
  }
  std::string text = states_text() + reasons_.text(frames_.size()) + figures_text(with_timing);
  if (!truth_.empty()) {
    text += errors_text() + reaction_text();
  }
  if (found_top_) {
    text += "quay's top  " + quay_keys(*found_top_) +
            ", as the joints have it; for [quay] once they are checked\n";
  }
  return text;
}

std::string ReplaySummary::states_text() const {
  std::array<std::size_t, 8> counts{};
  std::size_t later = 0;
  std::size_t later_healthy = 0;
  for (const Frame& f : frames_) {
    ++counts[static_cast<std::size_t>(f.state)];
    if (f.t_ns - frames_.front().t_ns >= kSecond) {
      ++later;
      later_healthy += healthy(f.state) ? 1 : 0;
    }
  }
  std::string text = format_text("frames      %zu in %.1f s\nstates     ", frames_.size(),
                                 static_cast<double>(frames_.back().t_ns - frames_.front().t_ns) * 1e-9);
  for (std::size_t s = 0; s < counts.size(); ++s) {
    if (counts[s] > 0) {
      text += format_text(" %s %zu", state_name(static_cast<State>(s)), counts[s]);
    }
  }
  const auto tracking = counts[static_cast<std::size_t>(State::tracking)];
  text +=
      format_text("\nhealthy     %.2f %%; after the first second %.2f %%\n",
                  100.0 * static_cast<double>(tracking) / static_cast<double>(frames_.size()),
                  later == 0 ? 0.0 : 100.0 * static_cast<double>(later_healthy) / static_cast<double>(later));
  return text;
}

std::string ReplaySummary::figures_text(bool with_timing) const {
  std::vector<double> q1;
  std::vector<double> q1_expected;
  std::vector<double> iterations;
  std::vector<double> ms;
  for (const Frame& f : frames_) {
    if (f.q1 >= 0.0) {
      q1.push_back(f.q1);
    }
    if (f.q1_expected >= 0.0) {
      q1_expected.push_back(f.q1_expected);
    }
    if (f.registered) {
      iterations.push_back(f.iterations);
    }
    ms.push_back(f.ms);
  }
  std::string text =
      format_text("Q1          median %.3f m, 99 %% %.3f m", percentile(q1, 0.5), percentile(q1, 0.99));
  if (!q1_expected.empty()) {
    text += format_text("; expected median %.3f m, 99 %% %.3f m", percentile(q1_expected, 0.5),
                        percentile(q1_expected, 0.99));
  }
  text += '\n';
  text += format_text("iterations  median %.0f, 99 %% %.0f\n", percentile(iterations, 0.5),
                      percentile(iterations, 0.99));
  if (with_timing) {
    text += format_text("time        median %.1f ms, 99 %% %.1f ms a frame\n", percentile(ms, 0.5),
                        percentile(ms, 0.99));
  }
  return text;
}

std::string ReplaySummary::errors_text() const {
  std::vector<double> error;
  std::vector<double> turn;
  std::size_t wrong = 0;
  std::size_t gross = 0;
  for (const Frame& f : frames_) {
    if (healthy(f.state) && f.error >= 0.0) {
      error.push_back(f.error);
      turn.push_back(f.turn_deg);
      wrong += f.error > HealthContract::kPosition || radians(f.turn_deg) > HealthContract::kAttitude ? 1 : 0;
      gross += f.error > kGrossError || f.turn_deg > kGrossTurnDeg ? 1 : 0;
    }
  }
  std::string text =
      format_text("error       RMS %.3f m, 99 %% %.3f m, max %.3f m of %zu healthy frames\n",
                  root_mean_square(error), percentile(error, 0.99), largest(error), error.size());
  text += format_text("rotation    RMS %.3f deg, 99 %% %.3f deg, max %.3f deg\n", root_mean_square(turn),
                      percentile(turn, 0.99), largest(turn));
  text += format_text(
      "wrong       %zu healthy frames off by more than %.2f m or %.1f deg; gross, %.2f m or %.1f deg: %zu\n",
      wrong, HealthContract::kPosition, degrees(HealthContract::kAttitude), kGrossError, kGrossTurnDeg,
      gross);
  return text;
}

std::string ReplaySummary::reaction_text() const {
  const auto crossing = std::find_if(frames_.begin(), frames_.end(),
                                     [](const Frame& f) { return f.moving || f.error > kGrossError; });
  if (crossing == frames_.end()) {
    return "reaction    the hull never passed max_speed, no pose was off by more than 0.10 m\n";
  }
  const auto is_healthy = [](const Frame& f) { return healthy(f.state); };
  const auto since_crossing = [&](const Frame& f) {
    return static_cast<double>(f.t_ns - crossing->t_ns) * 1e-9;
  };
  std::string text =
      format_text("reaction    frame %u: %s; ", crossing->number,
                  crossing->moving ? "the hull passes max_speed" : "the pose is off by 0.10 m");
  const auto fallen = std::find_if_not(crossing, frames_.end(), is_healthy);
  if (fallen == crossing) {
    text += "health was 0 by then\n";
  } else if (fallen == frames_.end()) {
    text += "health stayed 1\n";
  } else {
    text += format_text("health 0 after %.1f s\n", since_crossing(*fallen));
  }
  return text;
}

}  // namespace hulltrack
