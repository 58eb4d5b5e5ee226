// What the link makes of everything a PLC and its network can do wrong. Losses are counted in polls,
// never in wall time.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <csignal>
#include <vector>

#include "tests/integration/plc/plc_bench_setup.hpp"

namespace hulltrack {
namespace {

using sim::PlcFault;
using sim::PlcServer;
using testing::HasSubstr;

/// A healthy server at (12.5 m, -30 deg, 7.25 deg) and a client that has polled it once.
struct Bench {
  explicit Bench(Nanoseconds response_timeout = kPatient, sim::PlcServerConfig settings = {})
      : server(settings), client(make_config(settings, response_timeout), clock_of(clock)) {
    server.set_joints(12.5, -30.0, 7.25);
  }
  PlcConfig make_config(const sim::PlcServerConfig& settings, Nanoseconds response_timeout) {
    PlcConfig config = client_config(server, response_timeout);
    config.read = settings.read;
    config.write = settings.write;
    return config;
  }

  PlcServer server;
  TestClock clock;
  PlcClient client;
};

TEST(PlcFaults, RefusedAtStartIsAnOutcomeAndTheLinkComesUpByItself) {
  Bench bench;
  bench.server.set_fault(PlcFault::refuse);
  const PlcPoll poll = bench.client.poll();
  EXPECT_EQ(poll.outcome, LinkOutcome::unreachable);
  EXPECT_THAT(poll.message, HasSubstr("no connection: Connection refused"));
  EXPECT_THAT(poll.message, HasSubstr("plc.host"));
  bench.server.set_fault(PlcFault::none);
  EXPECT_EQ(polls_lost(bench.client, bench.clock), 0);
}

TEST(PlcFaults, ABlackHoleIsGivenUpWithinTheResponseTimeout) {
  Bench bench(kImpatient);
  bench.server.set_fault(PlcFault::black_hole);
  const auto begun = std::chrono::steady_clock::now();
  const PlcPoll poll = bench.client.poll();
  const auto waited = std::chrono::steady_clock::now() - begun;
  EXPECT_EQ(poll.outcome, LinkOutcome::unreachable);
  EXPECT_THAT(poll.message, HasSubstr("timed out"));
  EXPECT_GE(waited, kImpatient);
  EXPECT_LT(waited, 60s);  // the kernel alone would try for two minutes
  bench.server.set_fault(PlcFault::none);
  EXPECT_LT(polls_lost(bench.client, bench.clock), 100);
}

TEST(PlcFaults, AnOpenConnectionThatFallsIntoABlackHoleTimesOut) {
  Bench bench(kImpatient);
  ASSERT_LT(polls_lost(bench.client, bench.clock), 100);
  bench.server.set_fault(PlcFault::black_hole);
  EXPECT_EQ(bench.client.poll().outcome, LinkOutcome::timeout);
  EXPECT_EQ(bench.client.poll().outcome, LinkOutcome::unreachable);
  EXPECT_EQ(bench.client.poll().outcome, LinkOutcome::waiting);
  bench.server.set_fault(PlcFault::none);
  EXPECT_LT(polls_lost(bench.client, bench.clock), 100);
}

TEST(PlcFaults, BackOffGrowsFromAFifthOfASecondToOneSecond) {
  Bench bench;
  bench.server.set_fault(PlcFault::refuse);
  std::vector<double> attempts;
  const SteadyTime begun = bench.clock.now;
  for (int i = 0; i < 500; ++i) {  // 10 s
    if (bench.client.poll().outcome == LinkOutcome::unreachable) {
      attempts.push_back(to_seconds(bench.clock.now - begun));
    }
    bench.clock.advance(20ms);
  }
  ASSERT_GE(attempts.size(), 10U);
  EXPECT_DOUBLE_EQ(attempts[0], 0.0);
  EXPECT_NEAR(attempts[1] - attempts[0], 0.02, 1e-9);
  EXPECT_NEAR(attempts[2] - attempts[1], 0.2, 0.021);
  EXPECT_NEAR(attempts[3] - attempts[2], 0.4, 0.021);
  EXPECT_NEAR(attempts[4] - attempts[3], 0.8, 0.021);
  for (std::size_t i = 5; i < attempts.size(); ++i) EXPECT_NEAR(attempts[i] - attempts[i - 1], 1.0, 0.021);
}

TEST(PlcFaults, AResetCostsOnePoll) {
  Bench bench;
  ASSERT_TRUE(bench.client.poll().ok());
  bench.server.set_fault(PlcFault::reset, 1);
  EXPECT_EQ(bench.client.poll().outcome, LinkOutcome::closed);
  EXPECT_TRUE(bench.client.poll().ok());
  EXPECT_EQ(bench.client.connections(), 2U);
  EXPECT_EQ(bench.server.most_connections(), 1);
}

TEST(PlcFaults, AResetBetweenRequestsCostsOneWriteAndRaisesNoSignal) {
  std::signal(SIGPIPE, SIG_DFL);
  Bench bench;
  ASSERT_TRUE(bench.client.write({}).ok());
  for (int i = 0; i < 10; ++i) {
    bench.server.set_fault(PlcFault::refuse);  // resets what is open
    bench.server.set_fault(PlcFault::none);
    EXPECT_EQ(bench.client.write({}).outcome, LinkOutcome::closed);
    EXPECT_TRUE(bench.client.write({}).ok());
  }
}

TEST(PlcFaults, ASilentPlcIsLeftAndFoundAgainWithOneSocketAtATime) {
  Bench bench(kImpatient);
  ASSERT_LT(polls_lost(bench.client, bench.clock), 100);
  bench.server.set_fault(PlcFault::silent);
  EXPECT_EQ(bench.client.poll().outcome, LinkOutcome::timeout);
  EXPECT_FALSE(bench.client.connected());
  EXPECT_EQ(bench.client.poll().outcome, LinkOutcome::timeout);
  EXPECT_EQ(bench.client.poll().outcome, LinkOutcome::waiting);
  bench.clock.advance(200ms);
  const PlcPoll third = bench.client.poll();
  EXPECT_EQ(third.outcome, LinkOutcome::timeout);
  EXPECT_THAT(third.message, HasSubstr("plc.response_timeout_ms = 500"));
  bench.server.set_fault(PlcFault::none);
  EXPECT_LT(polls_lost(bench.client, bench.clock), 100);
  EXPECT_EQ(bench.server.most_connections(), 1);
}

TEST(PlcFaults, ALateReplyIsNeverTakenForTheNextOnes) {
  Bench bench(kImpatient);
  ASSERT_LT(polls_lost(bench.client, bench.clock), 100);
  for (int i = 0; i < 3; ++i) {
    bench.server.set_fault(PlcFault::late_reply, 1);
    EXPECT_EQ(bench.client.poll().outcome, LinkOutcome::timeout);
    bench.server.set_joints(i, 0, 0);
    const PlcPoll next = bench.client.poll();
    if (next.outcome == LinkOutcome::timeout) continue;  // the machine was slower than the time-out
    ASSERT_EQ(next.outcome, LinkOutcome::ok);
    EXPECT_EQ(next.reading.travel_m, i);
  }
}

TEST(PlcFaults, AReplyWithAnotherTransactionIdCostsOnePoll) {
  Bench bench;
  ASSERT_TRUE(bench.client.poll().ok());
  bench.server.set_fault(PlcFault::wrong_transaction, 1);
  EXPECT_EQ(bench.client.poll().outcome, LinkOutcome::garbled);
  EXPECT_TRUE(bench.client.poll().ok());
  EXPECT_EQ(bench.server.most_connections(), 1);
}

TEST(PlcFaults, ADuplicateReplyCostsOnePollAndNeverDeliversOldValues) {
  Bench bench;
  bench.server.set_joints(0, 0, 0);
  ASSERT_TRUE(bench.client.poll().ok());
  bench.server.set_fault(PlcFault::duplicate_reply, 1);
  ASSERT_TRUE(bench.client.poll().ok());
  bench.server.set_joints(1, 0, 0);
  EXPECT_EQ(bench.client.poll().outcome, LinkOutcome::garbled);
  const PlcPoll next = bench.client.poll();
  ASSERT_TRUE(next.ok());
  EXPECT_EQ(next.reading.travel_m, 1);
}

TEST(PlcFaults, ATruncatedReplyIsATimeOut) {
  Bench bench(kImpatient);
  ASSERT_LT(polls_lost(bench.client, bench.clock), 100);
  bench.server.set_fault(PlcFault::truncated_reply, 1);
  EXPECT_EQ(bench.client.poll().outcome, LinkOutcome::timeout);
  EXPECT_LT(polls_lost(bench.client, bench.clock), 100);
}

// 25 bytes 40 ms apart: each within any byte time-out, the whole within twice the response time-out.
TEST(PlcFaults, ADribbledReplyIsCutOffByTheResponseTimeout) {
  Bench bench(kImpatient, {.dribble = 40ms});
  ASSERT_LT(polls_lost(bench.client, bench.clock), 100);
  bench.server.set_fault(PlcFault::dribbled_reply, 1);
  EXPECT_EQ(bench.client.poll().outcome, LinkOutcome::timeout);
  EXPECT_LT(polls_lost(bench.client, bench.clock), 100);
}

TEST(PlcFaults, AnExceptionKeepsTheLinkAndNamesBlockAndKey) {
  Bench bench;
  ASSERT_TRUE(bench.client.poll().ok());
  struct Case {
    PlcFault fault;
    int code;
    const char* read_words;
    const char* write_words;
  };
  for (const Case& c : {Case{PlcFault::illegal_function, 1, "function code 03", "function code 16"},
                        Case{PlcFault::illegal_address, 2, "plc.read.base", "plc.write.base"},
                        Case{PlcFault::illegal_value, 3, "plc.read.base", "plc.write.base"}}) {
    bench.server.set_fault(c.fault, 2);
    const PlcPoll poll = bench.client.poll();
    EXPECT_EQ(poll.outcome, LinkOutcome::exception);
    EXPECT_EQ(poll.exception, c.code);
    EXPECT_THAT(poll.message, HasSubstr("holding registers 0 to 7 (plc.read)"));
    EXPECT_THAT(poll.message, HasSubstr(c.read_words));
    const PlcWrite write = bench.client.write({});
    EXPECT_EQ(write.exception, c.code);
    EXPECT_THAT(write.message, HasSubstr("holding registers 100 to 139 (plc.write)"));
    EXPECT_THAT(write.message, HasSubstr(c.write_words));
    EXPECT_TRUE(bench.client.poll().ok());
  }
  EXPECT_EQ(bench.client.connections(), 1U);
}

TEST(PlcFaults, ABusyPlcIsAskedAgainAtTheNextPoll) {
  Bench bench;
  bench.server.set_fault(PlcFault::busy, 3);
  for (int i = 0; i < 3; ++i) {
    const PlcPoll poll = bench.client.poll();
    EXPECT_EQ(poll.outcome, LinkOutcome::exception);
    EXPECT_EQ(poll.exception, 6);
  }
  EXPECT_TRUE(bench.client.poll().ok());
  EXPECT_EQ(bench.client.connections(), 1U);
}

TEST(PlcFaults, AFrozenHeartbeatBringsNoFreshSampleThoughJointsMove) {
  Bench bench;
  EXPECT_TRUE(bench.client.poll().fresh);
  EXPECT_FALSE(bench.client.poll().fresh);  // same PLC cycle
  bench.server.set_joints(1, 0, 0);
  EXPECT_TRUE(bench.client.poll().fresh);
  bench.server.set_fault(PlcFault::frozen_heartbeat);
  for (int i = 0; i < 5; ++i) {
    bench.server.set_joints(2 + i, 0, 0);
    const PlcPoll poll = bench.client.poll();
    EXPECT_TRUE(poll.ok());
    EXPECT_FALSE(poll.fresh);
  }
  bench.server.set_fault(PlcFault::none);
  bench.server.set_joints(9, 0, 0);
  EXPECT_TRUE(bench.client.poll().fresh);
}

TEST(PlcFaults, WithoutAHeartbeatRegisterEveryPollIsFresh) {
  PlcServer server({});
  PlcConfig config = client_config(server);
  config.heartbeat_timeout = Nanoseconds{0};
  PlcClient client(config);
  EXPECT_TRUE(client.poll().fresh);
  EXPECT_TRUE(client.poll().fresh);
}

TEST(PlcFaults, ATornBlockIsKnownByItsTailCopy) {
  sim::PlcServerConfig settings;
  settings.read.heartbeat_tail = 8;
  Bench bench(kPatient, settings);
  EXPECT_FALSE(bench.client.poll().reading.torn);
  bench.server.set_fault(PlcFault::torn_block, 1);
  bench.server.set_joints(20, 21, 22);
  const PlcPoll torn = bench.client.poll();
  ASSERT_TRUE(torn.ok());
  EXPECT_EQ(torn.reading.travel_m, 20);
  EXPECT_EQ(torn.reading.slew_deg, -30);  // of the cycle before
  EXPECT_TRUE(torn.reading.torn);
  EXPECT_FALSE(torn.fresh);
  const PlcPoll whole = bench.client.poll();
  EXPECT_FALSE(whole.reading.torn);
  EXPECT_TRUE(whole.fresh);  // the torn read did not use the cycle up
  EXPECT_EQ(whole.reading.slew_deg, 21);
}

TEST(PlcFaults, ValuesThatNobodyMayBelieveArriveAsTheyAre) {
  Bench bench;
  bench.server.set_fault(PlcFault::not_a_number, 1);
  EXPECT_TRUE(std::isnan(bench.client.poll().reading.travel_m));
  bench.server.set_fault(PlcFault::infinite, 1);
  EXPECT_TRUE(std::isinf(bench.client.poll().reading.travel_m));
  bench.server.set_fault(PlcFault::out_of_range, 1);
  EXPECT_EQ(bench.client.poll().reading.travel_m, 501.0);
  EXPECT_EQ(bench.client.poll().reading.travel_m, 12.5);
}

TEST(PlcFaults, OnlyThePlcsOwnWordOrderReadsItsJoints) {
  for (const WordOrder theirs : {WordOrder::abcd, WordOrder::cdab, WordOrder::badc, WordOrder::dcba}) {
    sim::PlcServerConfig settings;
    settings.read.word_order = theirs;
    PlcServer server(settings);
    server.set_joints(123.456, 1.0, 2.0);
    for (const WordOrder ours : {WordOrder::abcd, WordOrder::cdab, WordOrder::badc, WordOrder::dcba}) {
      PlcConfig config = client_config(server);
      config.read.word_order = ours;
      PlcClient client(config);
      const PlcPoll poll = client.poll();
      ASSERT_TRUE(poll.ok());
      EXPECT_EQ(poll.reading.travel_m == static_cast<double>(123.456F), ours == theirs);
    }
  }
}

TEST(PlcFaults, ARefusedWriteStopsOurHeartbeatThereAndLeavesTheReadingAlone) {
  Bench bench;
  ASSERT_TRUE(bench.client.write({}).ok());
  const std::uint16_t heartbeat = bench.server.peek(100);
  bench.server.set_fault(PlcFault::write_refused);
  const PlcWrite refused = bench.client.write({});
  EXPECT_EQ(refused.outcome, LinkOutcome::exception);
  EXPECT_THAT(refused.message, HasSubstr("protects"));
  EXPECT_EQ(bench.server.peek(100), heartbeat);
  EXPECT_TRUE(bench.client.poll().ok());
  bench.server.set_fault(PlcFault::none);
  ASSERT_TRUE(bench.client.write({}).ok());
  EXPECT_NE(bench.server.peek(100), heartbeat);
  EXPECT_EQ(bench.client.connections(), 1U);
}

TEST(PlcFaults, AnotherMasterInOurBlockIsFoundByTheReadBackOnceASecond) {
  Bench bench;
  ASSERT_EQ(bench.client.write({}).read_back, ReadBack::not_due);
  bench.server.poke(107, 0x1234);
  bench.clock.advance(500ms);
  EXPECT_EQ(bench.client.write({}).read_back, ReadBack::not_due);
  bench.server.poke(107, 0x1234);
  bench.clock.advance(500ms);
  const PlcWrite found = bench.client.write({});
  EXPECT_EQ(found.read_back, ReadBack::overwritten);
  EXPECT_THAT(found.read_back_message, HasSubstr("register 107 (offset 7) holds 0x1234, we wrote 0x0000"));
  EXPECT_TRUE(found.ok());
  EXPECT_EQ(bench.server.peek(107), 0);  // and written over at once
  bench.clock.advance(1s);
  EXPECT_EQ(bench.client.write({}).read_back, ReadBack::matches);
}

TEST(PlcFaults, AReconnectedPlcIsNotAccusedOfOverwriting) {
  Bench bench;
  ASSERT_TRUE(bench.client.write({}).ok());
  bench.server.set_fault(PlcFault::reset, 1);
  EXPECT_EQ(bench.client.write({}).outcome, LinkOutcome::closed);
  bench.server.poke(107, 0x1234);  // a restart clears registers, too
  bench.clock.advance(5s);
  const PlcWrite write = bench.client.write({});
  EXPECT_TRUE(write.ok());
  EXPECT_EQ(write.read_back, ReadBack::not_due);
}

TEST(PlcFaults, AFullConnectionPoolIsNotStormed) {
  Bench bench;
  bench.server.set_fault(PlcFault::pool_full);
  for (int i = 0; i < 500; ++i) {  // 10 s
    EXPECT_FALSE(bench.client.poll().ok());
    bench.clock.advance(20ms);
  }
  EXPECT_LE(bench.server.connections(), 15U);
  EXPECT_EQ(bench.server.most_connections(), 0);
  bench.server.set_fault(PlcFault::none);
  EXPECT_LE(polls_lost(bench.client, bench.clock), 51);
  EXPECT_EQ(bench.server.most_connections(), 1);
}

TEST(PlcFaults, AnyBytesForAReplyLeaveALinkThatRunsAgain) {
  Bench bench(10ms);
  bench.server.set_fault(PlcFault::garbage_reply);
  for (int i = 0; i < 300; ++i) {
    static_cast<void>(bench.client.poll());
    bench.clock.advance(1s);
    static_cast<void>(bench.client.write({}));
    bench.clock.advance(1s);
  }
  bench.server.set_fault(PlcFault::none);
  EXPECT_TRUE(poll_until_ok(bench.client, bench.clock).poll.ok());
}

TEST(PlcFaults, EveryFaultEndsInARunningLinkWithOneSocket) {
  sim::PlcServerConfig settings;
  settings.read.heartbeat_tail = 8;
  settings.dribble = 40ms;
  Bench bench(kImpatient, settings);
  for (int fault = 1; fault <= static_cast<int>(PlcFault::out_of_range); ++fault) {
    bench.server.set_fault(static_cast<PlcFault>(fault));
    static_cast<void>(bench.client.poll());
    static_cast<void>(bench.client.write({}));
    bench.server.set_fault(PlcFault::none);
    bench.server.set_joints(fault, 0, 0);
    const Recovery recovery = poll_until_ok(bench.client, bench.clock);
    EXPECT_TRUE(recovery.poll.ok()) << "fault " << fault;
    EXPECT_EQ(recovery.poll.reading.travel_m, fault);
  }
  EXPECT_EQ(bench.server.most_connections(), 1);
}

}  // namespace
}  // namespace hulltrack
