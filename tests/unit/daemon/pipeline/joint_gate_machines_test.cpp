// Machines at work, drawn at random, behind PLCs and gateways with all their jitter: what the gate makes of
// values that are true, and of values that are not.
#include <gtest/gtest.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <functional>
#include <random>
#include <vector>

#include "core/geometry/se3.hpp"
#include "daemon/pipeline/joint_gate.hpp"

namespace hulltrack {
namespace {

using Verdict = JointGate::Verdict;

/// Some of the fastest loaders: 30 m/min, .3 r/min; luff 8 m/min at 40 m.
constexpr JointValues kSpeed{0.5, radians(1.8), radians(0.2)};
constexpr double kRamp = 2.5;     // s from rest to full speed
constexpr double kRun = 40.0;     // s of a run
constexpr double kSettled = 3.0;  // s before anything goes wrong

/// One joint that starts, runs and stops at random times, in steps of a millisecond.
class Axis {
 public:
  Axis(double start, double speed, std::mt19937& random) : value_{start} {
    double wanted = 0.0;
    double now = 0.0;
    double until = 0.0;
    for (int i = 0; i < kSteps; ++i) {
      if (i * kStep >= until) {
        wanted = speed * (static_cast<double>(random() % 3) - 1.0) * share(random);
        until = i * kStep + 1.0 + 6.0 * share(random);
      }
      const double change = speed / kRamp * kStep;
      now += std::clamp(wanted - now, -change, change);
      value_.push_back(value_.back() + now * kStep);
      speed_.push_back(now);
    }
  }
  [[nodiscard]] double at(double t) const { return value_[index(t)]; }
  [[nodiscard]] double speed(double t) const { return speed_[index(t)]; }

 private:
  static constexpr double kStep = 1e-3;
  static constexpr int kSteps = static_cast<int>(kRun / kStep);
  static double share(std::mt19937& random) { return std::uniform_real_distribution(0.0, 1.0)(random); }
  static std::size_t index(double t) {
    return static_cast<std::size_t>(std::clamp(static_cast<int>(t / kStep), 0, kSteps - 1));
  }
  std::vector<double> value_, speed_;
};

struct Machine {
  Axis travel, slew, luff;
  explicit Machine(std::mt19937& random)
      : travel(10.0 + static_cast<double>(random() % 20), kSpeed[0], random),
        slew(radians(40.0), kSpeed[1], random),
        luff(radians(-3.0), kSpeed[2], random) {}
  [[nodiscard]] Joints at(double t) const { return {travel.at(t), slew.at(t), luff.at(t)}; }
};

struct Site {
  double cycle;   // s, of the PLC
  double jitter;  // s, of the gateway
  bool heartbeat = true;
  double poll = 0.02;  // s
};

/// What the PLC shows of cycle `k`; may lie.
using Shown = std::function<Joints(double t, std::int64_t k, const Joints& truth)>;

Joints honest(double /*t*/, std::int64_t /*k*/, const Joints& truth) { return truth; }

struct Polled {
  double t = 0.0;  // s
  JointGate::Outcome outcome;
  JointValues shown{}, truth{};
};

Joints through_encoders(const Joints& joints) {
  const auto rounded = [](double value, double step) { return std::round(value / step) * step; };
  const double code = 2.0 * std::numbers::pi / 65536.0;
  return {rounded(joints.d_x, 0.001), rounded(joints.theta_r, code), rounded(joints.theta_p, code)};
}

/// A run through the gate, reading by reading.
std::vector<Polled> run(const Machine& machine, const Site& site, std::mt19937& random, const Shown& shown) {
  JointGate gate({.travel = {-500.0, 500.0, 1.0},
                  .slew = {radians(-360.0), radians(360.0), radians(3.0)},
                  .luff = {radians(-90.0), radians(90.0), radians(3.0)},
                  .poll_period = Nanoseconds{static_cast<std::int64_t>(site.poll * 1e9)},
                  .has_heartbeat = site.heartbeat});
  std::uniform_real_distribution delay(0.0, site.jitter);
  const double latency =
      site.jitter / 2 + (site.heartbeat ? std::min(site.poll, site.cycle) : site.cycle) / 2;
  std::vector<Polled> all;
  std::int64_t newest = 0;
  for (double t = 1.0; t < kRun - 1.0; t += site.poll) {
    newest = std::max(newest, static_cast<std::int64_t>((t - delay(random)) / site.cycle));
    const Joints truth = through_encoders(machine.at(static_cast<double>(newest) * site.cycle));
    const Joints joints = shown(t, newest, truth);
    const auto stamp = measurement_time_from_ns(static_cast<std::int64_t>((t - latency) * 1e9));
    Polled polled{t, gate.offer({{stamp, joints}, static_cast<std::uint16_t>(newest)}), values_of(joints),
                  values_of(truth)};
    if (polled.outcome.verdict != Verdict::no_news) {
      all.push_back(std::move(polled));
    }
  }
  return all;
}

constexpr std::array kSites{Site{0.01, 0.005}, Site{0.01, 0.03},        Site{0.02, 0.03},
                            Site{0.02, 0.01},  Site{0.02, 0.03, false}, Site{0.02, 0.03, true, 0.05}};

TEST(JointGateMachines, AMachineAtWorkIsNeverRefused) {
  for (unsigned seed = 0; seed < 30; ++seed) {
    for (const Site& site : kSites) {
      std::mt19937 random(seed);
      const Machine machine(random);
      for (const Polled& polled : run(machine, site, random, honest)) {
        ASSERT_EQ(polled.outcome.verdict, Verdict::believed)
            << "seed " << seed << ", cycle " << site.cycle << ", jitter " << site.jitter << ", t " << polled.t
            << ": " << polled.outcome.reason;
      }
    }
  }
}

TEST(JointGateMachines, ASlowPlcCostsASampleNowAndThenAndNeverAGap) {
  std::size_t refused = 0;
  std::size_t all = 0;
  for (unsigned seed = 0; seed < 30; ++seed) {
    for (const Site& site : {Site{0.05, 0.03}, Site{0.05, 0.03, false}, Site{0.05, 0.03, true, 0.1}}) {
      std::mt19937 random(seed);
      const Machine machine(random);
      for (const Polled& polled : run(machine, site, random, honest)) {
        ASSERT_NE(polled.outcome.verdict, Verdict::on_trial) << polled.outcome.reason;
        ++all;
        refused += polled.outcome.verdict == Verdict::refused ? 1U : 0U;
      }
    }
  }
  EXPECT_LT(1000 * refused, all) << refused << " of " << all;
}

/// What a believed value is off by: 1 is half of the contract, or what 50 ms of jitter make of a joint's
/// speed if that is more. The gate allows as much about a prediction that is off by as much itself, so a
/// single value up to 2 may pass; a frame has five.
double error(const Polled& polled, const Machine& machine) {
  const auto speed = [&](const Axis& axis) {
    return std::max(std::abs(axis.speed(polled.t)), std::abs(axis.speed(polled.t - 0.3)));
  };
  const JointValues speeds{speed(machine.travel), speed(machine.slew), speed(machine.luff)};
  double worst = 0.0;
  for (std::size_t i = 0; i < speeds.size(); ++i) {
    worst = std::max(
        worst, std::abs(polled.shown[i] - polled.truth[i]) / std::max(kHalfContract[i], 0.05 * speeds[i]));
  }
  return worst;
}

constexpr double kHarmless = 2.0;

TEST(JointGateMachines, AStepIsRefusedOrHarmless) {
  for (unsigned seed = 0; seed < 60; ++seed) {
    std::mt19937 random(seed);
    const Machine machine(random);
    const double when = kSettled + 20.0 * std::uniform_real_distribution(0.0, 1.0)(random);
    const double size = std::exp(std::uniform_real_distribution(-4.0, 3.0)(random));  // 2 cm to 20 m
    const bool turn = seed % 2 == 1;
    const auto step = [&](double t, std::int64_t, Joints truth) {
      (turn ? truth.theta_r : truth.d_x) += t < when ? 0.0 : (turn ? radians(2.0 * size) : size);
      return truth;
    };
    for (const Polled& polled : run(machine, kSites[seed % kSites.size()], random, step)) {
      if (polled.outcome.verdict == Verdict::believed) {
        ASSERT_LE(error(polled, machine), kHarmless)
            << "seed " << seed << ", t " << polled.t << ", step " << size;
      }
    }
  }
}

TEST(JointGateMachines, AGapWithWhateverBehindItIsRefusedOrHarmless) {
  std::size_t believed = 0;
  for (unsigned seed = 0; seed < 200; ++seed) {
    std::mt19937 random(seed);
    const Machine machine(random);
    std::uniform_real_distribution share(0.0, 1.0);
    const double from = kSettled + 20.0 * share(random);
    const double until = from + 0.3 + 3.0 * share(random) * share(random);
    const double off = seed % 3 == 0 ? 0.0 : (share(random) < 0.5 ? -1.0 : 1.0) * 2.0 * share(random);
    const auto gap = [&](double t, std::int64_t, Joints truth) {
      truth.d_x = t < from ? truth.d_x : t < until ? std::nan("") : truth.d_x + off;
      return truth;
    };
    for (const Polled& polled : run(machine, kSites[seed % 4], random, gap)) {
      if (polled.outcome.verdict == Verdict::believed) {
        ASSERT_LE(error(polled, machine), kHarmless)
            << "seed " << seed << ", t " << polled.t << ", off " << off;
        believed += polled.t > until ? 1U : 0U;
      }
    }
  }
  EXPECT_GT(believed, 0U) << "some machines come back by themselves";
}

/// Both words of the float, of two cycles.
double torn(double newer, double older) {
  const auto bits = [](double value) { return std::bit_cast<std::uint32_t>(static_cast<float>(value)); };
  return std::bit_cast<float>((bits(newer) & 0xFFFF0000U) | (bits(older) & 0xFFFFU));
}

TEST(JointGateMachines, ATornReadIsRefusedOrHarmlessAndCostsNoGap) {
  std::size_t bad = 0;
  for (unsigned seed = 0; seed < 60; ++seed) {
    std::mt19937 random(seed);
    const Machine machine(random);
    const Site& site = kSites[seed % 2];
    const auto tear = [&](double, std::int64_t k, Joints truth) {
      if (random() % 10 < 3) {
        const Joints older = through_encoders(machine.at(static_cast<double>(k - 1) * site.cycle));
        truth.d_x = torn(truth.d_x, older.d_x);
        truth.theta_r = radians(torn(degrees(truth.theta_r), degrees(older.theta_r)));
      }
      return truth;
    };
    for (const Polled& polled : run(machine, site, random, tear)) {
      bad += error(polled, machine) > kHarmless ? 1U : 0U;
      ASSERT_NE(polled.outcome.verdict, Verdict::on_trial) << "seed " << seed << ", t " << polled.t;
      if (polled.outcome.verdict == Verdict::believed) {
        ASSERT_LE(error(polled, machine), kHarmless) << "seed " << seed << ", t " << polled.t;
      }
    }
  }
  EXPECT_GT(bad, 100U) << "the PLC was bad enough to say something";
}

TEST(JointGateMachines, ATravelThatFreezesAtFullSpeedIsRefusedWithinAFifthOfASecond) {
  int seen = 0;
  for (unsigned seed = 0; seed < 200; ++seed) {
    std::mt19937 random(seed);
    const Machine machine(random);
    double when = kSettled;
    const auto fast = [&](double t) { return std::abs(machine.travel.speed(t)) > 0.45; };
    while (when < 30.0 && !(fast(when) && fast(when - 0.3) && fast(when + 1.5))) when += 0.1;
    if (when >= 30.0) continue;
    ++seen;
    const double frozen = through_encoders(machine.at(when)).d_x;
    const auto freeze = [&](double t, std::int64_t k, Joints truth) {
      const double shown_of = static_cast<double>(k) * kSites[seed % 4].cycle;
      truth.d_x = t > when && shown_of >= when && t < when + 1.5 ? frozen : truth.d_x;
      return truth;
    };
    for (const Polled& polled : run(machine, kSites[seed % 4], random, freeze)) {
      if (polled.outcome.verdict == Verdict::believed) {
        ASSERT_LE(std::abs(polled.shown[0] - polled.truth[0]), 0.5 * 0.2)
            << "seed " << seed << ", t " << polled.t;
      }
    }
  }
  EXPECT_GT(seen, 30);
}

}  // namespace
}  // namespace hulltrack
