// From the PLC's registers to the joints that a scan is placed with: what a machine at work, read through a
// real Modbus link, comes to when the PLC or its encoders misbehave. On a clock that only the test moves.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

#include "core/kinematics/joint_history.hpp"
#include "daemon/pipeline/plc_reading.hpp"
#include "tests/integration/plc/plc_bench_setup.hpp"

namespace hulltrack {
namespace {

using sim::PlcFault;
using sim::PlcServer;
using Verdict = JointGate::Verdict;

JointGateConfig gate_config() {
  return {.travel = {-500.0, 500.0, 1.0},
          .slew = {radians(-360.0), radians(360.0), radians(3.0)},
          .luff = {radians(-90.0), radians(90.0), radians(3.0)}};
}

/// A loader that travels at .5 m/s and slews at 1.5 deg/s; its PLC's cycle is that of the polls.
class Loader {
 public:
  /// One cycle of 20 ms. `moves`: the machine; `encoders`: what its PLC shows of it.
  JointGate::Outcome cycle(bool moves = true, bool encoders = true) {
    clock_.advance(20ms);
    travel_ += moves ? 0.5 * 0.02 : 0.0;
    slew_ += moves ? 1.5 * 0.02 : 0.0;
    if (encoders) {
      shown_travel_ = travel_;
      shown_slew_ = slew_;
    }
    server.set_joints(shown_travel_, shown_slew_, 5.0);
    return poll();
  }
  /// Its encoders show zeros, its heartbeat counts.
  JointGate::Outcome cold_cycle() {
    clock_.advance(20ms);
    server.set_joints(0.0, 0.0, 0.0);
    return poll();
  }
  void off(Nanoseconds duration) { clock_.advance(duration); }
  void command(std::uint16_t word) { server.set_command(word); }
  /// How far what would be believed now is from where the machine is, in halves of the contract.
  [[nodiscard]] double error() const {
    return std::max(std::abs(last_.d_x - travel_) / kHalfContract[0],
                    std::abs(last_.theta_r - radians(slew_)) / kHalfContract[1]);
  }

  PlcServer server{{}};

 private:
  JointGate::Outcome poll() {
    const PlcPoll answer = client_.poll();
    EXPECT_TRUE(answer.ok());
    const PlcReading& r = answer.reading;
    last_ = {r.travel_m, radians(r.slew_deg), radians(r.luff_deg)};
    const MeasurementTime time{clock_.now.time_since_epoch()};
    return take_plc_reading({{time, last_}, r.heartbeat}, r.command, latch_, gate_);
  }

  TestClock clock_;
  PlcClient client_{client_config(server), clock_of(clock_)};
  JointGate gate_{gate_config()};
  CommandLatch latch_;
  Joints last_;
  double travel_ = 8.0, slew_ = 32.0;
  double shown_travel_ = 8.0, shown_slew_ = 32.0;
};

TEST(PlcJoints, AMachineAtWorkIsBelievedPollByPoll) {
  Loader loader;
  for (int i = 0; i < 300; ++i) ASSERT_EQ(loader.cycle().verdict, Verdict::believed) << i;
}

TEST(PlcJoints, TornWordsAreNeverBelievedAndCostNoGap) {
  Loader loader;
  std::mt19937 random{5};
  for (int i = 0; i < 50; ++i) ASSERT_EQ(loader.cycle().verdict, Verdict::believed);
  int refused = 0;
  for (int i = 0; i < 700; ++i) {  // 7 m, 21 deg
    if (random() % 10 < 3) loader.server.set_fault(PlcFault::torn_words, 1);
    const JointGate::Outcome outcome = loader.cycle();
    ASSERT_NE(outcome.verdict, Verdict::on_trial);
    ASSERT_TRUE(outcome.verdict == Verdict::refused || loader.error() < 1.5) << i;
    refused += outcome.verdict == Verdict::refused ? 1 : 0;
  }
  EXPECT_GT(refused, 10);
}

TEST(PlcJoints, AnEncoderBusThatHiccupsWhileTheMachineMovesHealsByItself) {
  Loader loader;
  for (int i = 0; i < 100; ++i) ASSERT_EQ(loader.cycle().verdict, Verdict::believed);
  int believed = 0;
  for (int i = 0; i < 20; ++i) believed += loader.cycle(true, false).verdict == Verdict::believed ? 1 : 0;
  EXPECT_LE(believed, 6);
  JointGate::Outcome outcome;
  for (int i = 0; i < 75; ++i) {
    outcome = loader.cycle();
    ASSERT_TRUE(outcome.verdict != Verdict::believed || loader.error() < 1.0);
  }
  EXPECT_EQ(outcome.verdict, Verdict::believed) << outcome.reason;
}

TEST(PlcJoints, AColdStartOfAParkedMachineHealsByItselfOfAMovedOneWithAnEdge) {
  for (const bool moved : {false, true}) {
    Loader loader;
    for (int i = 0; i < 100; ++i) ASSERT_EQ(loader.cycle(false).verdict, Verdict::believed);
    loader.off(40s);
    for (int i = 0; i < 100; ++i) ASSERT_NE(loader.cold_cycle().verdict, Verdict::believed);
    for (int i = 0; moved && i < 10; ++i) ASSERT_NE(loader.cycle().verdict, Verdict::believed);
    JointGate::Outcome outcome;
    for (int i = 0; i < 100; ++i) outcome = loader.cycle(false);
    EXPECT_EQ(outcome.verdict, moved ? Verdict::on_trial : Verdict::believed) << outcome.reason;
    EXPECT_EQ(outcome.needs_edge, moved);
    loader.command(kCommandReacquire);
    EXPECT_EQ(loader.cycle(false).verdict, Verdict::believed);
  }
}

}  // namespace
}  // namespace hulltrack
