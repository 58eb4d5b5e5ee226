#include "core/tracking/health.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <functional>
#include <random>
#include <vector>

namespace hulltrack {
namespace {

using std::chrono::milliseconds;

HealthLimits limits() { return health_limits(TrackerConfig{}, 60.0); }

FrameFindings good(int frame) {
  FrameFindings e;
  e.time = MeasurementTime{frame * milliseconds(100)};
  e.bracketed = e.registration.found = e.registration.converged = true;
  e.registration.matched = 1000;
  e.examination.metrics = {true, 0.08, 0.1, 0.1, 0.12, 0.1, 3000, 0.08};
  return e;
}

/// A machine that runs frame after frame.
struct Machine {
  HealthLimits set = limits();
  HealthMemory memory;
  int frame = 0;

  HealthVerdict step(const std::function<void(FrameFindings&)>& change = {}) {
    FrameFindings e = good(frame++);
    if (change) {
      change(e);
    }
    e.search.number = memory.track.searches;
    auto [next, verdict] = judge_health(set, memory, e);
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
  std::function<void(FrameFindings&)> change;
  State state;    // of the frame, when it was tracking before
  Faults faults;  // exactly
};

const std::vector<Case>& cases() {
  static const std::vector<Case> all{
      {"nothing registered",
       [](FrameFindings& e) {
         e.registration.found = e.registration.converged = false;
         e.registration.matched = 0;
         e.registration.trouble = "none";
       },
       State::lost, fault::few_matches | fault::not_converged},
      {"not converged",
       [](FrameFindings& e) {
         e.registration.converged = false;
         e.registration.trouble = "iterations";
       },
       State::degraded, fault::not_converged},
      {"few matches", [](FrameFindings& e) { e.registration.matched = 199; }, State::lost,
       fault::few_matches},
      {"Q1 between the limits", [](FrameFindings& e) { e.examination.metrics.q1 = 1.51 * 0.08; },
       State::degraded, fault::q1_high},
      {"Q1 above lost", [](FrameFindings& e) { e.examination.metrics.q1 = 3.01 * 0.08; }, State::lost,
       fault::q1_high},
      {"nothing to expect of Q1", [](FrameFindings& e) { e.examination.metrics.q1_expected.reset(); },
       State::degraded, fault::q1_high},
      {"no map in view", [](FrameFindings& e) { e.examination.metrics.valid = false; }, State::lost,
       fault::q1_high},
      {"contradicted",
       [](FrameFindings& e) { e.examination.integrity = {.faults = fault::contradicted, .reason = "off"}; },
       State::lost, fault::contradicted},
      {"unconstrained",
       [](FrameFindings& e) { e.examination.integrity = {.faults = fault::unconstrained, .reason = "free"}; },
       State::degraded, fault::unconstrained},
      {"outside the envelope", [](FrameFindings& e) { e.registration.pose.T_W_H.translation().y() = 2.01; },
       State::lost, fault::implausible},
      {"jump", [](FrameFindings& e) { e.registration.pose.T_W_H.translation().x() = 1.5; }, State::degraded,
       fault::implausible},
      {"turn",
       [](FrameFindings& e) {
         e.registration.pose.T_W_H.linear() = rotation_from_rpy({0, 0, radians(3.0)});
       },
       State::degraded, fault::implausible},
      {"joints do not bracket", [](FrameFindings& e) { e.bracketed = e.registration.found = false; },
       State::fault, fault::plc_stale},
      {"PLC stale", [](FrameFindings& e) { e.standing = fault::plc_stale; }, State::fault, fault::plc_stale},
      {"PLC value and no bracket",
       [](FrameFindings& e) {
         e.standing = fault::plc_value;
         e.bracketed = e.registration.found = false;
       },
       State::fault, fault::plc_stale | fault::plc_value},
      {"a LiDAR of several silent", [](FrameFindings& e) { e.standing = fault::lidar_silent; },
       State::degraded, fault::lidar_silent},
      {"held", [](FrameFindings& e) { e.hold = true; }, State::held, 0},
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

/// What a machine that was tracking says of one frame with this Q1.
HealthVerdict verdict_on(double q1, std::optional<double> expected, const HealthLimits& set = limits()) {
  Machine machine;
  machine.set = set;
  machine.run(10);
  return machine.step([&](FrameFindings& e) {
    e.examination.metrics.q1 = q1;
    e.examination.metrics.q1_expected = expected;
  });
}

TEST(Health, JudgesQ1ByWhatTheSensorShouldSee) {
  EXPECT_EQ(verdict_on(0.6, 0.41).state, State::tracking) << "a sparse sensor";
  EXPECT_EQ(verdict_on(0.11, 0.07).state, State::degraded) << "a dense one";
  const HealthVerdict lost = verdict_on(0.31, 0.1);
  EXPECT_EQ(lost.state, State::lost);
  EXPECT_EQ(lost.reason,
            "Q1 0.310 m is 3.10 times the 0.100 m that this sensor should see, q1_ratio_lost is 3.00");
}

TEST(Health, ASitesOwnLimitsOfQ1HoldBesides) {
  HealthLimits set = limits();
  set.health.q1_healthy = 0.1;
  EXPECT_EQ(verdict_on(0.09, 0.08, set).state, State::tracking);
  EXPECT_EQ(verdict_on(0.11, 0.11, set).state, State::degraded) << "as expected, but above the site's";
  EXPECT_EQ(verdict_on(0.09, 0.05, set).state, State::degraded) << "below the site's, but unexpected";
  EXPECT_EQ(verdict_on(0.5, 0.5, set).state, State::degraded) << "no limit is set that says lost";
  set.health.q1_lost = 0.2;
  EXPECT_EQ(verdict_on(0.19, 0.19, set).state, State::degraded);
  const HealthVerdict lost = verdict_on(0.21, 0.21, set);
  EXPECT_EQ(lost.state, State::lost);
  EXPECT_EQ(lost.reason, "Q1 0.210 m is above q1_lost 0.200 m");
}

TEST(Health, ASitesOwnLimitDecidesAloneWhereNothingIsExpected) {
  HealthLimits set = limits();
  set.health.q1_lost = 0.2;
  EXPECT_EQ(verdict_on(0.08, std::nullopt, set).state, State::degraded) << "nothing says what is healthy";
  EXPECT_EQ(verdict_on(0.21, std::nullopt, set).state, State::lost);
  set.health.q1_healthy = 0.1;
  EXPECT_EQ(verdict_on(0.08, std::nullopt, set).state, State::tracking);
  EXPECT_EQ(verdict_on(0.11, std::nullopt, set).state, State::degraded);
}

TEST(Health, Q1OfAFewPointsLeavesTheDecisionToIntegrity) {
  const auto few = [](FrameFindings& e) {
    e.examination.metrics.q1 = 0.5;
    e.examination.metrics.q1_expected.reset();
    e.examination.metrics.few_surfels = true;
  };
  Machine machine = tracking_machine();
  EXPECT_EQ(machine.step(few).state, State::tracking);
  const HealthVerdict verdict = machine.step([&](FrameFindings& e) {
    few(e);
    e.examination.integrity = {.faults = fault::unconstrained, .reason = "few here as well"};
  });
  EXPECT_EQ(verdict.state, State::degraded);
  EXPECT_EQ(verdict.faults, fault::unconstrained) << "of Q1 nothing is known";
  EXPECT_EQ(verdict.reason, "few here as well");
  machine.set.health.q1_healthy = 0.4;
  EXPECT_EQ(machine.step(few).faults, fault::q1_high) << "a site's own limit holds";
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

TEST(Health, NothingIsHealthyWithJointsOnTrialButGoodFramesCount) {
  Machine machine = tracking_machine();
  const auto on_trial = [](FrameFindings& e) {
    e.standing = fault::plc_value;
    e.joints_on_trial = true;
    e.joint_trouble = "travel waits";
  };
  for (int i = 0; i < 20; ++i) {
    const HealthVerdict verdict = machine.step(on_trial);
    ASSERT_EQ(verdict.state, State::degraded);
    EXPECT_EQ(verdict.faults, fault::plc_value);
    EXPECT_EQ(verdict.reason, "travel waits");
  }
  EXPECT_EQ(machine.step().state, State::tracking) << "what is believed now was right then";
}

TEST(Health, NothingIsHealthyWhileItIsOpenWhichOfTwoSensorsIsMeant) {
  Machine machine = tracking_machine();
  const HealthVerdict verdict = machine.step([](FrameFindings& e) { e.standing = fault::foreign_packets; });
  EXPECT_EQ(verdict.state, State::degraded);
  EXPECT_EQ(verdict.faults, fault::foreign_packets);
  EXPECT_NE(verdict.reason.find("set `source`"), std::string::npos);
}

TEST(Health, AScanWithoutJointsTellsWhyTheyWereRefused) {
  Machine machine = tracking_machine();
  const HealthVerdict verdict = machine.step([](FrameFindings& e) {
    e.bracketed = false;
    e.joint_trouble = "luff 97.000 deg is outside";
  });
  EXPECT_EQ(verdict.reason, "no joint samples bracket the scan: luff 97.000 deg is outside");
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

TEST(Health, IsAcquiringUntilTheBerthIsSearchedWhateverElseIsWrong) {
  Machine machine;
  const auto searching = [](FrameFindings& e) { e.search = {1, 13, std::nullopt}; };
  for (const Case& c : cases()) {
    const HealthVerdict verdict = machine.step([&](FrameFindings& e) {
      searching(e);
      c.change(e);
    });
    const bool idle = c.state == State::fault || c.state == State::held;
    EXPECT_EQ(verdict.state, idle ? c.state : State::acquiring) << c.what;
    EXPECT_FALSE(verdict.reason.empty()) << c.what;
  }
  for (int i = 0; i < 20; ++i) {
    EXPECT_EQ(machine.step(searching).state, State::acquiring) << "good frames";
  }
  EXPECT_EQ(machine.step().state, State::tracking);
}

TEST(Health, ABerthThatIsSearchedAtOnceStillAsksForRecoverFrames) {
  Machine machine;
  for (int i = 0; i < 4; ++i) {
    EXPECT_NE(machine.step().state, State::tracking);
  }
  EXPECT_EQ(machine.step().state, State::tracking);
}

TEST(Health, AJumpWhileUniqueTakesHealthUntilThePoseIsBackWhereItCameFrom) {
  Machine machine = tracking_machine();
  for (int i = 0; i < 5; ++i) {
    const HealthVerdict verdict =
        machine.step([](FrameFindings& e) { e.registration.pose.T_W_H.translation().x() = 0.9; });
    EXPECT_EQ(verdict.state, State::degraded);
    EXPECT_EQ(verdict.faults, fault::implausible);
    EXPECT_TRUE(machine.memory.track.unique);
  }
  machine.run(5);
  EXPECT_EQ(machine.memory.state, State::tracking);
}

TEST(Health, ReacquireForgetsTheLastPoseAndStartsTheSearch) {
  const auto far_away = [](FrameFindings& e) { e.registration.pose.T_W_H.translation().x() = 8.0; };
  Machine machine = tracking_machine();
  EXPECT_EQ(machine.step(far_away).state, State::degraded) << "a jump";
  const auto searching = [&](FrameFindings& e) {
    far_away(e);
    e.search = {4, 13, std::nullopt};
  };
  const HealthVerdict edge = machine.step([&](FrameFindings& e) {
    searching(e);
    e.reacquire = true;
  });
  EXPECT_EQ(edge.state, State::acquiring);
  EXPECT_EQ(edge.faults, 0) << "no jump from a pose that is forgotten";
  EXPECT_NE(edge.reason.find("0 of 13"), std::string::npos) << edge.reason << ": it has yet to begin";
  for (int i = 0; i < 20; ++i) {
    EXPECT_EQ(machine.step(searching).state, State::acquiring) << "the search goes on";
  }
  EXPECT_EQ(machine.step(far_away).state, State::tracking) << "it is complete, after many good frames";
}

/// As many frames out of sight as bring the way that a hull can move, 0.6 m/s, beyond kUnseen less noise.
constexpr int kFramesOutOfSight = 16;

TEST(Health, AHullOutOfSightForLongIsSearchedForBeforeItIsBelieved) {
  const auto elsewhere = [](FrameFindings& e) {
    e.examination.integrity = {.faults = fault::contradicted, .reason = "off"};
  };
  Machine brief = tracking_machine();
  for (int i = 0; i < 13; ++i) {
    EXPECT_EQ(brief.step(elsewhere).faults, fault::contradicted);
  }
  brief.run(5);
  EXPECT_EQ(brief.memory.state, State::tracking) << "it cannot have gone far";

  Machine machine = tracking_machine();
  for (int i = 0; i < kFramesOutOfSight; ++i) {
    (void)machine.step(elsewhere);
  }
  EXPECT_FALSE(machine.memory.track.unique);
  for (int i = 0; i < 100; ++i) {
    const HealthVerdict verdict = machine.step([](FrameFindings& e) { e.search = {7, 13, std::nullopt}; });
    ASSERT_EQ(verdict.state, State::acquiring) << i;
  }
  EXPECT_EQ(machine.step().state, State::tracking) << "searched through, and no rival";
}

TEST(Health, ASearchThatEndedBeforeThePlaceWasLostDoesNotGiveItBack) {
  // Held for long enough that she may have been warped to the next hatch; the finder has not searched since.
  Machine machine = tracking_machine();
  machine.frame += 40;
  EXPECT_EQ(machine.step().state, State::acquiring);
  EXPECT_FALSE(machine.memory.track.unique);
  EXPECT_EQ(machine.step([](FrameFindings& e) { e.search = {8, 13, std::nullopt}; }).state, State::acquiring);
  machine.run(5);
  EXPECT_EQ(machine.memory.state, State::tracking) << "searched through since";

  Machine checked = tracking_machine();
  EXPECT_EQ(checked.step([](FrameFindings& e) { e.reacquire = true; }).state, State::acquiring)
      << "nor does one that ended before the edge";
}

TEST(Health, ARivalKeepsHealthAwayAndSaysWhere) {
  Machine machine = tracking_machine();
  const auto rivalled = [](FrameFindings& e) { e.search = {13, 13, Eigen::Vector3d(23.0, 0.1, -0.2)}; };
  EXPECT_EQ(machine.step(rivalled).state, State::tracking) << "while it is followed there are none";
  (void)machine.step([&](FrameFindings& e) {
    rivalled(e);
    e.reacquire = true;
  });
  for (int i = 0; i < 100; ++i) {
    const HealthVerdict verdict = machine.step(rivalled);
    ASSERT_EQ(verdict.state, State::acquiring);
    ASSERT_EQ(verdict.faults, fault::ambiguous);
    EXPECT_NE(verdict.reason.find("23.0, 0.1, -0.2"), std::string::npos) << verdict.reason;
  }
  EXPECT_EQ(machine.step().state, State::tracking);
}

TEST(Health, WhileTheBerthIsSearchedABetterPlaceIsNoJump) {
  Machine machine;
  (void)machine.step([](FrameFindings& e) { e.search = {4, 13, std::nullopt}; });
  const HealthVerdict verdict = machine.step([](FrameFindings& e) {
    e.search = {8, 13, std::nullopt};
    e.registration.pose.T_W_H.translation().x() = 9.0;
  });
  EXPECT_EQ(verdict.faults, 0) << verdict.reason;
  EXPECT_EQ(verdict.state, State::acquiring);
}

TEST(Health, JumpMayGrowWithTheTimeSinceTheLastPoseThatWasFollowed) {
  Machine machine = tracking_machine();
  for (int i = 0; i < 10; ++i) {
    (void)machine.step([](FrameFindings& e) { e.examination.metrics.q1 = 0.3; });
  }
  const auto moved = [](FrameFindings& e) { e.registration.pose.T_W_H.translation().x() = 0.3; };  // in 1.1 s
  EXPECT_EQ(machine.step(moved).faults & fault::implausible, 0);
}

/// The reason after a pose that is `metres` along and `deg` of roll away, `unseen` frames after the last one.
std::string after_a_gap(int unseen, double metres, double deg) {
  Machine machine = tracking_machine();
  for (int i = 0; i < unseen; ++i) {
    (void)machine.step([](FrameFindings& e) { e.examination.metrics.q1 = 0.3; });
  }
  return machine
      .step([&](FrameFindings& e) {
        e.registration.pose.T_W_H.translation().x() = metres;
        e.registration.pose.T_W_H.linear() =
            Eigen::AngleAxisd(radians(deg), Eigen::Vector3d::UnitX()).toRotationMatrix();
      })
      .reason;
}

TEST(Health, AJumpIsWhatErrorsAndTheFastestHullDoNotExplainTogether) {
  // 0.1 m, and 0.6 m/s for as long as nobody saw her.
  for (const auto& [unseen, farthest] : {std::pair{0, 0.16}, std::pair{10, 0.76}}) {
    EXPECT_EQ(after_a_gap(unseen, farthest - 0.01, 0.0).find("jumped"), std::string::npos) << unseen;
    EXPECT_NE(after_a_gap(unseen, farthest + 0.01, 0.0).find("jumped"), std::string::npos) << unseen;
  }
}

TEST(Health, ATurnIsWhatErrorsAndTheSwellDoNotExplainTogether) {
  // 0.3 deg, and 1 deg/s.
  for (const auto& [unseen, farthest] : {std::pair{0, 0.4}, std::pair{10, 1.4}}) {
    EXPECT_EQ(after_a_gap(unseen, 0.0, farthest - 0.02).find("turned"), std::string::npos) << unseen;
    EXPECT_NE(after_a_gap(unseen, 0.0, farthest + 0.02).find("turned"), std::string::npos) << unseen;
  }
}

TEST(Health, SteadySpeedAboveTheLimitTakesHealth) {
  for (const double speed : {0.25, 0.35}) {
    Machine machine = tracking_machine();
    bool healthy = true;
    for (int i = 1; i <= 20; ++i) {
      healthy =
          machine
              .step([&](FrameFindings& e) { e.registration.pose.T_W_H.translation().x() = speed * 0.1 * i; })
              .state == State::tracking;
    }
    EXPECT_EQ(healthy, speed < 0.3) << speed;
  }
}

/// `seconds` of a hull that moves along x as `x` says, each pose off by `noise` in x, y and z; when it passed
/// for too fast, from 1 s on.
std::vector<double> alarms(const std::function<double(double)>& x, double seconds, double noise,
                           unsigned seed, double first_t = 0.0) {
  std::mt19937 random(seed);
  std::normal_distribution<double> error(0.0, noise);
  Machine machine;
  std::vector<double> result;
  for (int i = 0; 0.1 * i < seconds; ++i) {
    const double t = first_t + 0.1 * i;
    const HealthVerdict verdict = machine.step([&](FrameFindings& e) {
      e.registration.pose.T_W_H.translation() =
          Eigen::Vector3d(x(t) + error(random), error(random), error(random));
    });
    if (i >= 10 && (verdict.faults & fault::implausible) != 0) {
      result.push_back(t);
    }
  }
  return result;
}

constexpr double kPoseNoise = 0.003;      // m, what a scan in clear air leaves
constexpr double kLargestNoise = 0.0125;  // m, four of it are the largest error that health allows

TEST(Health, AHullThatSetsOffLosesItWithinHalfASecondOfPassingTheLimit) {
  for (const double acceleration : {0.05, 0.1, 0.16, 0.4, 2.0}) {
    const double passed = 0.3 / acceleration;
    for (unsigned seed = 1; seed <= 100; ++seed) {
      const auto x = [&](double t) { return t < 0.0 ? 0.0 : 0.5 * acceleration * t * t; };
      const double offset = 0.001 * seed;  // of the frames, which do not wait for the hull
      const std::vector<double> when = alarms(x, passed + 4.0, kPoseNoise, seed, offset - 3.0);
      ASSERT_FALSE(when.empty());
      EXPECT_LE(when.front(), passed + 0.5) << acceleration << " m/s2, seed " << seed;
      EXPECT_GE(when.front(), passed - 0.5) << acceleration << " m/s2, seed " << seed;
    }
  }
}

TEST(Health, NoiseOfTheWorstScanThatHealthAllowsPassesForNoSpeed) {
  for (unsigned seed = 1; seed <= 100; ++seed) {
    EXPECT_TRUE(alarms([](double) { return 0.0; }, 30.0, kLargestNoise, seed).empty()) << "at rest " << seed;
    const auto creeping = [](double t) { return 0.15 * t; };
    EXPECT_TRUE(alarms(creeping, 13.0, kLargestNoise, seed).empty()) << "at 0.15 m/s " << seed;
  }
}

TEST(Health, AHullThatSpeedsUpToBelowTheLimitKeepsIt) {
  const auto x = [](double t) {  // 0.05 m/s2 up to 0.25 m/s
    const double gaining = std::clamp(t - 2.0, 0.0, 5.0);
    return 0.025 * gaining * gaining + 0.25 * std::max(0.0, t - 7.0);
  };
  for (unsigned seed = 1; seed <= 100; ++seed) {
    EXPECT_TRUE(alarms(x, 20.0, kPoseNoise, seed).empty()) << seed;
  }
}

TEST(Health, TurningFasterThanTheEndsMayMoveTakesHealth) {
  // 0.3 m/s 60 m from the middle is 0.29 deg/s, and noise 0.1.
  for (const double rate_deg : {0.25, 0.5, -0.5}) {
    Machine machine = tracking_machine();
    HealthVerdict verdict;
    for (int i = 1; i <= 20; ++i) {
      verdict = machine.step([&](FrameFindings& e) {
        e.registration.pose.T_W_H.linear() =
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
                  .step([&](FrameFindings& e) {
                    e.registration.pose.T_W_H.linear() =
                        Eigen::AngleAxisd(roll, Eigen::Vector3d::UnitX()).toRotationMatrix();
                  })
                  .state,
              State::tracking);
  }
}

TEST(Health, RefusedPlcValueBetweenGoodOnesIsReportedAndCostsNothing) {
  Machine machine = tracking_machine();
  const HealthVerdict verdict = machine.step([](FrameFindings& e) { e.standing = fault::plc_value; });
  EXPECT_EQ(verdict.state, State::tracking);
  EXPECT_EQ(verdict.faults, fault::plc_value);
}

}  // namespace
}  // namespace hulltrack
