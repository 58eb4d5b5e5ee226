#include "core/tracking/health.hpp"

#include <gtest/gtest.h>

#include <functional>

namespace hulltrack {
namespace {

using std::chrono::milliseconds;

HealthLimits limits() { return health_limits(TrackerConfig{}, 60.0); }

Evidence good(int frame) {
  Evidence e;
  e.time = MeasurementTime{frame * milliseconds(100)};
  e.bracketed = e.registered = e.converged = true;
  e.matched = 1000;
  e.metrics = {true, 0.08, 0.1, 0.1, 0.12, 0.1, 3000};
  return e;
}

/// A machine that runs frame after frame.
struct Machine {
  HealthMemory memory;
  int frame = 0;

  HealthVerdict step(const std::function<void(Evidence&)>& change = {}) {
    Evidence e = good(frame++);
    if (change) {
      change(e);
    }
    auto [next, verdict] = judge_health(limits(), memory, e);
    memory = next;
    return verdict;
  }
  void run(int frames) {
    for (int i = 0; i < frames; ++i) {
      (void)step();
    }
  }
};

Machine tracking_machine() {
  Machine machine;
  machine.run(10);
  return machine;
}

struct Case {
  const char* what;
  std::function<void(Evidence&)> change;
  State state;    // of the frame, when it was tracking before
  Faults faults;  // exactly
};

const std::vector<Case>& cases() {
  static const std::vector<Case> all{
      {"nothing registered",
       [](Evidence& e) {
         e.registered = e.converged = false;
         e.matched = 0;
         e.trouble = "none";
       },
       State::lost, fault::few_matches | fault::not_converged},
      {"not converged",
       [](Evidence& e) {
         e.converged = false;
         e.trouble = "iterations";
       },
       State::degraded, fault::not_converged},
      {"few matches", [](Evidence& e) { e.matched = 199; }, State::lost, fault::few_matches},
      {"Q1 between the limits", [](Evidence& e) { e.metrics.q1 = 0.121; }, State::degraded, fault::q1_high},
      {"Q1 above lost", [](Evidence& e) { e.metrics.q1 = 0.251; }, State::lost, fault::q1_high},
      {"no map in view", [](Evidence& e) { e.metrics.valid = false; }, State::lost, fault::q1_high},
      {"contradicted",
       [](Evidence& e) {
         e.integrity = {fault::contradicted, "off"};
       },
       State::lost, fault::contradicted},
      {"unconstrained",
       [](Evidence& e) {
         e.integrity = {fault::unconstrained, "free"};
       },
       State::degraded, fault::unconstrained},
      {"outside the envelope", [](Evidence& e) { e.displacement.y() = 2.01; }, State::lost,
       fault::implausible},
      {"jump", [](Evidence& e) { e.displacement.x() = 1.5; }, State::degraded, fault::implausible},
      {"turn",
       [](Evidence& e) {
         e.rotation = rotation_from_rpy({0, 0, radians(5.0)});
       },
       State::degraded, fault::implausible},
      {"joints do not bracket", [](Evidence& e) { e.bracketed = e.registered = false; }, State::fault,
       fault::plc_stale},
      {"PLC stale", [](Evidence& e) { e.plc_faults = fault::plc_stale; }, State::fault, fault::plc_stale},
      {"PLC value and no bracket",
       [](Evidence& e) {
         e.plc_faults = fault::plc_value;
         e.bracketed = e.registered = false;
       },
       State::fault, fault::plc_stale | fault::plc_value},
      {"held", [](Evidence& e) { e.hold = true; }, State::held, 0},
  };
  return all;
}

TEST(Health, EveryFailedCheckTakesHealthAtOnceAndSaysWhy) {
  for (const Case& c : cases()) {
    Machine machine = tracking_machine();
    const HealthVerdict verdict = machine.step(c.change);
    EXPECT_EQ(verdict.state, c.state) << c.what;
    EXPECT_EQ(verdict.faults, c.faults) << c.what;
    EXPECT_FALSE(verdict.reason.empty()) << c.what;
  }
}

TEST(Health, ReturnsAfterRecoverFramesGoodFramesInARow) {
  for (const Case& c : cases()) {
    Machine machine = tracking_machine();
    (void)machine.step(c.change);
    for (int i = 1; i < 5; ++i) {
      const HealthVerdict verdict = machine.step();
      EXPECT_EQ(verdict.state, State::degraded) << c.what << ", good frame " << i;
      EXPECT_EQ(verdict.reason, i == 1 ? "recovering: 1 good frame of 5"
                                       : "recovering: " + std::to_string(i) + " good frames of 5")
          << c.what;
    }
    EXPECT_EQ(machine.step().state, State::tracking) << c.what;
  }
}

TEST(Health, ABadFrameStartsRecoveryAgain) {
  for (const Case& c : cases()) {
    Machine machine = tracking_machine();
    (void)machine.step(c.change);
    machine.run(4);
    (void)machine.step(c.change);
    machine.run(4);
    EXPECT_NE(machine.memory.state, State::tracking) << c.what;
    machine.run(1);
    EXPECT_EQ(machine.memory.state, State::tracking) << c.what;
  }
}

TEST(Health, IsAcquiringUntilFirstHealthy) {
  Machine machine;
  for (const Case& c : cases()) {
    const State state = machine.step(c.change).state;
    const State expected = c.state == State::fault || c.state == State::held ? c.state : State::acquiring;
    EXPECT_EQ(state, expected) << c.what;
  }
  Machine fresh;
  for (int i = 0; i < 4; ++i) {
    EXPECT_EQ(fresh.step().state, State::acquiring);
  }
  EXPECT_EQ(fresh.step().state, State::tracking);
}

TEST(Health, ReacquireForgetsTheLastPose) {
  const auto far_away = [](Evidence& e) { e.displacement.x() = 8.0; };
  Machine machine = tracking_machine();
  EXPECT_EQ(machine.step(far_away).state, State::degraded) << "a jump";
  const auto edge = [&](Evidence& e) {
    far_away(e);
    e.reacquire = true;
  };
  EXPECT_EQ(machine.step(edge).state, State::acquiring);
  for (int i = 0; i < 3; ++i) {
    EXPECT_EQ(machine.step(far_away).state, State::acquiring);
  }
  EXPECT_EQ(machine.step(far_away).state, State::tracking);
}

TEST(Health, HullThatWasElsewhereForLongIsAmbiguousUntilReacquired) {
  const auto elsewhere = [](Evidence& e) { e.integrity = {fault::contradicted, "off"}; };
  Machine brief = tracking_machine();
  for (int i = 0; i < 190; ++i) {  // 19 s
    EXPECT_EQ(brief.step(elsewhere).faults, fault::contradicted);
  }
  brief.run(5);
  EXPECT_EQ(brief.memory.state, State::tracking);

  Machine machine = tracking_machine();
  for (int i = 0; i < 210; ++i) {  // 21 s
    (void)machine.step(elsewhere);
  }
  for (int i = 0; i < 100; ++i) {
    const HealthVerdict verdict = machine.step();
    EXPECT_EQ(verdict.state, State::acquiring);
    EXPECT_EQ(verdict.faults, fault::ambiguous);
  }
  (void)machine.step([](Evidence& e) { e.reacquire = true; });
  machine.run(4);
  EXPECT_EQ(machine.memory.state, State::tracking);
}

TEST(Health, JumpMayGrowWithTheTimeSinceTheLastHealthyPose) {
  Machine machine = tracking_machine();
  for (int i = 0; i < 10; ++i) {
    (void)machine.step([](Evidence& e) { e.metrics.q1 = 0.2; });
  }
  const auto moved = [](Evidence& e) { e.displacement.x() = 0.3; };  // 1.1 s at 0.3 m/s and noise
  EXPECT_EQ(machine.step(moved).faults & fault::implausible, 0);
}

TEST(Health, SteadySpeedAboveTheLimitTakesHealth) {
  for (const double speed : {0.25, 0.35}) {
    Machine machine = tracking_machine();
    bool healthy = true;
    for (int i = 1; i <= 20; ++i) {
      healthy =
          machine.step([&](Evidence& e) { e.displacement.x() = speed * 0.1 * i; }).state == State::tracking;
    }
    EXPECT_EQ(healthy, speed < 0.3) << speed;
  }
}

TEST(Health, TurningFasterThanTheEndsMayMoveTakesHealth) {
  // 0.3 m/s 60 m from the middle is 0.29 deg/s, and noise 0.1.
  for (const double rate_deg : {0.25, 0.5, -0.5}) {
    Machine machine = tracking_machine();
    HealthVerdict verdict;
    for (int i = 1; i <= 20; ++i) {
      verdict = machine.step([&](Evidence& e) {
        e.rotation =
            Eigen::AngleAxisd(radians(rate_deg) * 0.1 * i, Eigen::Vector3d::UnitZ()).toRotationMatrix();
      });
    }
    EXPECT_EQ(verdict.state == State::tracking, rate_deg == 0.25) << rate_deg;
    if (rate_deg != 0.25) {
      EXPECT_EQ(verdict.faults, fault::implausible);
      EXPECT_NE(verdict.reason.find("0.50 deg/s"), std::string::npos) << verdict.reason;
    }
  }
}

TEST(Health, RollingAsWavesDoKeepsHealth) {
  Machine machine = tracking_machine();
  for (int i = 1; i <= 80; ++i) {  // 1 deg in 8 s: 0.8 deg/s at the most
    const double roll = radians(1.0) * std::sin(2.0 * 3.14159 * 0.1 * i / 8.0);
    EXPECT_EQ(machine
                  .step([&](Evidence& e) {
                    e.rotation = Eigen::AngleAxisd(roll, Eigen::Vector3d::UnitX()).toRotationMatrix();
                  })
                  .state,
              State::tracking);
  }
}

TEST(Health, RefusedPlcValueBetweenGoodOnesIsReportedAndCostsNothing) {
  Machine machine = tracking_machine();
  const HealthVerdict verdict = machine.step([](Evidence& e) { e.plc_faults = fault::plc_value; });
  EXPECT_EQ(verdict.state, State::tracking);
  EXPECT_EQ(verdict.faults, fault::plc_value);
}

TEST(MotionRecord, SlopeOfALineIsItsSpeed) {
  MotionRecord record;
  for (int i = 0; i < 30; ++i) {
    const double t = 0.1 * i;
    record.add(MeasurementTime{i * milliseconds(100)}, {0.2 * t, -0.1 * t, 5.0}, 0.3 - 0.01 * t);
  }
  ASSERT_TRUE(record.motion());
  EXPECT_TRUE(record.motion()->velocity.isApprox(Eigen::Vector3d(0.2, -0.1, 0.0), 1e-9));
  EXPECT_NEAR(record.motion()->yaw_rate, -0.01, 1e-9);
}

TEST(MotionRecord, FewPositionsHaveNoSpeed) {
  MotionRecord record;
  for (int i = 0; i < 3; ++i) {
    record.add(MeasurementTime{i * milliseconds(100)}, {1.0 * i, 0, 0}, 0.0);
    EXPECT_FALSE(record.motion());
  }
}

}  // namespace
}  // namespace hulltrack
