#include "daemon/simulator/berth/loader_motion.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "daemon/simulator/random.hpp"

namespace hulltrack {
namespace {

constexpr double kFirstMove = 3.0;  // s of rest at the beginning

/// A target inside the limits that is one move away.
double draw_target(const AxisLimits& axis, double from, RandomStream& random) {
  const auto draw = [&] {
    return random.uniform(std::max(axis.low, from - axis.longest_move),
                          std::min(axis.high, from + axis.longest_move));
  };
  double target = draw();
  while (std::abs(target - from) < axis.shortest_move) target = draw();
  return target;
}

/// What a loader does in turn to fill a hold: which axes move together.
struct Step {
  bool travel, slew, luff;
};
constexpr std::array<Step, 5> kSteps = {{{false, true, false},
                                         {false, true, true},
                                         {true, false, false},
                                         {false, false, true},
                                         {true, true, false}}};
constexpr Step kHurriedStep = {true, true, false};

}  // namespace

double LoaderMotion::Move::duration() const {
  const double distance = std::abs(to - from);
  const double ramp = speed / acceleration;
  if (distance < speed * ramp) return 2.0 * std::sqrt(distance / acceleration);
  return distance / speed + ramp;
}

double LoaderMotion::Move::at(double t) const {
  const double distance = std::abs(to - from);
  const double total = duration();
  const double elapsed = std::clamp(t - start, 0.0, total);
  const double peak = std::min(speed, std::sqrt(distance * acceleration));
  const double ramp = peak / acceleration;
  double covered = 0.0;
  if (elapsed < ramp) {
    covered = 0.5 * acceleration * elapsed * elapsed;
  } else if (elapsed < total - ramp) {
    covered = peak * (elapsed - 0.5 * ramp);
  } else {
    const double left = total - elapsed;
    covered = distance - 0.5 * acceleration * left * left;
  }
  return from + std::copysign(covered, to - from);
}

LoaderMotion::LoaderMotion(const LoaderLimits& limits, double duration, std::uint64_t seed) {
  RandomStream random(seed, 200);
  const auto inside = [&](const AxisLimits& axis) { return random.uniform(axis.low, axis.high); };
  start_ = {inside(limits.travel), inside(limits.slew), inside(limits.luff)};
  Joints now = start_;
  if (limits.passes) plan_passes(limits.travel, duration);
  double t = kFirstMove;
  std::size_t step = random.bits() % kSteps.size();
  while (t < duration) {
    double end = t;
    const auto move = [&](Track& track, const AxisLimits& axis, double& position) {
      const double target = draw_target(axis, position, random);
      track.push_back({t, position, target, axis.speed, axis.acceleration});
      position = target;
      end = std::max(end, t + track.back().duration());
    };
    const Step& now_moves = limits.hurries ? kHurriedStep : kSteps.at(step++ % kSteps.size());
    if (now_moves.slew) move(slew_, limits.slew, now.theta_r);
    if (now_moves.luff) move(luff_, limits.luff, now.theta_p);
    if (now_moves.travel && !limits.passes) move(travel_, limits.travel, now.d_x);
    t = end + random.uniform(limits.shortest_pour, limits.longest_pour);
  }
}

/// From the end of the range that is nearer to the start.
void LoaderMotion::plan_passes(const AxisLimits& axis, double duration) {
  const bool from_low = start_.d_x - axis.low < axis.high - start_.d_x;
  double from = from_low ? axis.low : axis.high;
  double to = from_low ? axis.high : axis.low;
  start_.d_x = from;
  for (double t = kFirstMove; t < duration; t += travel_.back().duration(), std::swap(from, to))
    travel_.push_back({t, from, to, axis.speed, axis.acceleration});
}

double LoaderMotion::position(const Track& track, double start, double t) {
  const auto next = std::upper_bound(track.begin(), track.end(), t,
                                     [](double time, const Move& move) { return time < move.start; });
  return next == track.begin() ? start : std::prev(next)->at(t);
}

bool LoaderMotion::at_rest(double t) const {
  const auto rests = [t](const Track& track) {
    return std::none_of(track.begin(), track.end(),
                        [t](const Move& move) { return t > move.start && t < move.start + move.duration(); });
  };
  return rests(travel_) && rests(slew_) && rests(luff_);
}

Joints LoaderMotion::at(double t) const {
  return {position(travel_, start_.d_x, t), position(slew_, start_.theta_r, t),
          position(luff_, start_.theta_p, t)};
}

}  // namespace hulltrack
