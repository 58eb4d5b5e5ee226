// What of a machine that lies about its joints the hull's own pose and motion show.
#include <gtest/gtest.h>

#include <functional>

#include "core/tracking/health.hpp"

namespace hulltrack {
namespace {

using std::chrono::milliseconds;

constexpr double kHalfLength = 60.0;  // m

/// Frames at 10 Hz, each good but for its pose; healthy to begin with.
class Frames {
 public:
  Frames() {
    run(1.5, [](double) { return Pose::Identity(); });
  }

  /// `T_W_H` against the seconds since this call, about a reference point in the origin.
  HealthVerdict run(double seconds, const std::function<Pose(double)>& T_W_H) {
    HealthVerdict verdict;
    for (double t = 0.1; t < seconds + 0.05; t += 0.1) {
      verdict = step(T_W_H(t), false);
    }
    return verdict;
  }

  HealthVerdict step(const Pose& T_W_H, bool reacquire) {
    FrameFindings e;
    e.time = MeasurementTime{frame_++ * milliseconds(100)};
    e.bracketed = e.registration.found = e.registration.converged = true;
    e.registration.matched = 1000;
    e.examination.metrics = {true, 0.08, 0.1, 0.1, 0.12, 0.1, 3000, 0.08};
    e.registration.pose.T_W_H.translation() = T_W_H.translation();
    e.registration.pose.T_W_H.linear() = T_W_H.linear();
    e.reacquire = reacquire;
    e.search.number = memory_.track.searches;
    auto [next, verdict] = judge_health(limits_, std::move(memory_), e);
    memory_ = std::move(next);
    return verdict;
  }

 private:
  HealthLimits limits_ = health_limits(TrackerConfig{}, kHalfLength);
  HealthMemory memory_;
  int frame_ = 0;
};

Pose turned(double roll_deg, double pitch_deg, double yaw_deg) {
  return pose_from_xyz_rpy_deg(Eigen::Vector3d::Zero(), {roll_deg, pitch_deg, yaw_deg});
}

Pose along(double x) { return Pose(Eigen::Translation3d(x, 0.0, 0.0)); }

TEST(HealthOfALyingMachine, AnAttitudeThatNoMooredShipHasIsLost) {
  struct Case {
    double roll, pitch, yaw;
    const char* key;  // nullptr = within all limits
  };
  for (const Case& c : {Case{3.9, 1.9, 3.4, nullptr}, Case{-3.9, -1.9, -3.4, nullptr},
                        Case{4.1, 0.0, 0.0, "hull.max_heel"}, Case{-4.1, 0.0, 0.0, "hull.max_heel"},
                        Case{0.0, 2.1, 0.0, "hull.max_trim"}, Case{0.0, -2.1, 0.0, "hull.max_trim"},
                        Case{0.0, 0.0, 3.6, "hull.max_yaw"}, Case{0.0, 0.0, -3.6, "hull.max_yaw"}}) {
    // At 0.1 deg/s, so that it is the attitude and not the way there.
    Frames frames;
    const auto turning = [&c](double t) {
      return turned(c.roll * t / 45.0, c.pitch * t / 45.0, c.yaw * t / 45.0);
    };
    const HealthVerdict verdict = frames.run(45.0, turning);
    if (c.key == nullptr) {
      EXPECT_EQ(verdict.state, State::tracking) << verdict.reason;
    } else {
      EXPECT_EQ(verdict.state, State::lost) << c.key;
      EXPECT_EQ(verdict.faults, fault::implausible) << c.key;
      EXPECT_NE(verdict.reason.find(c.key), std::string::npos) << verdict.reason;
    }
  }
}

TEST(HealthOfALyingMachine, AHullThatRunsFasterThanMaxSpeedForAMetreWaitsForAPerson) {
  Frames frames;
  const HealthVerdict running = frames.run(4.0, [](double t) { return along(0.5 * t); });
  EXPECT_EQ(running.state, State::lost);
  EXPECT_NE(running.reason.find("re-acquire edge"), std::string::npos) << running.reason;
  const HealthVerdict at_rest = frames.run(60.0, [](double) { return along(2.0); });
  EXPECT_EQ(at_rest.state, State::lost) << "an encoder that stood still: the ship seems to lie elsewhere now";
  EXPECT_EQ(at_rest.faults, fault::implausible);
  frames.step(along(2.0), true);
  EXPECT_EQ(frames.run(3.0, [](double) { return along(2.0); }).state, State::tracking);
}

TEST(HealthOfALyingMachine, AFastJerkThatEndsBelowAMetreIsForgotten) {
  Frames frames;
  for (int jerk = 0; jerk < 5; ++jerk) {  // 0.8 m each, to and fro, with a rest between them
    const double from = jerk % 2 == 0 ? 0.0 : 0.8;
    const double to = 0.8 - from;
    EXPECT_EQ(frames.run(2.0, [&](double t) { return along(from + (to - from) * t / 2.0); }).state,
              State::degraded);
    EXPECT_EQ(frames.run(5.0, [&](double) { return along(to); }).state, State::tracking) << jerk;
  }
}

TEST(HealthOfALyingMachine, ARunIsOneRunOverAPauseThatIsShorterThanItsSpeedIsKnown) {
  Frames frames;
  frames.run(1.6, [](double t) { return along(0.5 * t); });
  frames.run(0.5, [](double) { return along(0.8); });
  EXPECT_EQ(frames.run(1.6, [](double t) { return along(0.8 + 0.5 * t); }).state, State::lost);
}

TEST(HealthOfALyingMachine, ASlewThatStandsStillInThePlcTurnsTheShipsEndsTooFast) {
  // The loader slews at 1 deg/s for 2 deg; what stood still is the hull. Its ends run 60 m * 2 deg = 2.1 m.
  Frames frames;
  frames.run(2.0, [](double t) { return turned(0.0, 0.0, t); });
  const HealthVerdict verdict = frames.run(10.0, [](double) { return turned(0.0, 0.0, 2.0); });
  EXPECT_EQ(verdict.state, State::lost) << verdict.reason;
}

TEST(HealthOfALyingMachine, SurgingAtTheLinesIsNoRun) {
  Frames frames;  // 0.3 m, 30 s: 0.06 m/s
  EXPECT_EQ(frames.run(120.0, [](double t) { return along(0.3 * std::sin(2.0 * M_PI * t / 30.0)); }).state,
            State::tracking);
}

}  // namespace
}  // namespace hulltrack
