#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "daemon/pipeline/lidar_watch.hpp"
#include "daemon/pipeline/live_time.hpp"
#include "daemon/pipeline/plc_watch.hpp"
#include "tests/support/recording_log.hpp"

namespace hulltrack {
namespace {

using std::chrono::milliseconds;
using std::chrono::seconds;
using testing::HasSubstr;

constexpr SteadyTime kStart = SteadyTime{} + std::chrono::hours(1);

LidarConfig boom() {
  LidarConfig config;
  config.model = "velodyne_vlp16";
  config.source = "192.168.1.201";
  return config;
}

PlcConfig plc(Nanoseconds heartbeat_timeout) {
  PlcConfig config;
  config.host = "plc";
  config.heartbeat_timeout = heartbeat_timeout;
  return config;
}

class LidarWatchTest : public testing::Test {
 protected:
  Faults look(Nanoseconds t) { return watch.update(counters, kStart + t); }
  void packet(Nanoseconds t) {
    ++counters.status.packets;
    counters.status.last_received = live_measurement_time(kStart + t);
  }

  RecordingLog log;
  LidarWatch watch{boom(), 600.0, log, kStart};
  LidarCounters counters;
};

TEST_F(LidarWatchTest, SilenceIsAFaultAfterTheTimeoutAndEndsWithTheNextPacket) {
  EXPECT_EQ(look(milliseconds(500)), 0) << "at the start it has its time-out to speak up";
  EXPECT_EQ(look(milliseconds(501)), fault::lidar_silent);
  EXPECT_TRUE(watch.silent());
  EXPECT_THAT(log.last(), HasSubstr("LiDAR boom: no usable packet on UDP port 2368"));
  packet(seconds(3));
  EXPECT_EQ(look(seconds(3)), 0);
  EXPECT_THAT(log.last(), HasSubstr("packets again after 3.0 s"));
  EXPECT_EQ(look(milliseconds(3500)), 0);
  EXPECT_EQ(look(milliseconds(3501)), fault::lidar_silent);
}

TEST_F(LidarWatchTest, NamesTheForeignSender) {
  packet(seconds(1));
  counters.foreign = 37;
  counters.last_foreign = "10.0.0.9:4000";
  EXPECT_EQ(look(seconds(1)), 0) << "an event, not a standing condition";
  ASSERT_EQ(log.lines.size(), 1U);
  EXPECT_THAT(log.last(), HasSubstr("10.0.0.9:4000"));
  EXPECT_THAT(log.last(), HasSubstr("37 so far"));
}

TEST_F(LidarWatchTest, NamesTwoSensorsOnOnePortAndLetsNobodySteerWhileItIsOpenWhichIsMeant) {
  packet(seconds(1));
  counters.two_senders = "two sensors send to UDP port 2368: 192.168.1.201 and 192.168.1.202";
  counters.status.packets_of_another = 3;
  counters.status.disputed = true;
  EXPECT_EQ(look(seconds(1)), fault::foreign_packets);
  ASSERT_EQ(log.lines.size(), 1U);
  EXPECT_THAT(log.last(),
              HasSubstr("192.168.1.201 and 192.168.1.202; set `source` to the one that is meant"));
  EXPECT_THAT(log.last(), HasSubstr("health is 0"));
  counters.status.disputed = false;
  packet(milliseconds(1100));
  EXPECT_EQ(look(milliseconds(1100)), 0);
  EXPECT_EQ(log.lines.size(), 1U) << "once";
}

TEST_F(LidarWatchTest, WhatAPacketFilterDropsIsNoOverload) {
  packet(seconds(1));
  counters.filtered = 12;
  EXPECT_EQ(look(seconds(1)), 0);
  ASSERT_EQ(log.lines.size(), 1U);
  EXPECT_THAT(log.last(), HasSubstr("has kept 12 datagrams from UDP port 2368"));
  EXPECT_THAT(log.last(), HasSubstr("IPAddressAllow="));
}

TEST_F(LidarWatchTest, NamesWhatWasExpectedAndSeenFromAnotherModel) {
  counters.status.packets_rejected = 5;
  counters.last_rejection = "product 0x28 (VLP-32C) instead of 0x22";
  EXPECT_EQ(look(seconds(1)), fault::lidar_silent) << "no packet can be used";
  ASSERT_EQ(log.lines.size(), 2U);
  EXPECT_THAT(log.last(), HasSubstr("not those of a velodyne_vlp16: product 0x28 (VLP-32C) instead of 0x22"));
}

TEST_F(LidarWatchTest, TellsThatDataAreHeldBackOnceTheSensorShouldHaveToldItsAngles) {
  counters.status.packets_held_back = 100;
  (void)look(milliseconds(100));
  for (const auto& line : log.lines) EXPECT_THAT(line.text, Not(HasSubstr("held back")));
  counters.status.packets_held_back = 1000;
  (void)look(milliseconds(3100));
  EXPECT_THAT(log.last(), HasSubstr("its data are held back"));
  EXPECT_THAT(log.last(), HasSubstr("`information_port`"));
}

TEST_F(LidarWatchTest, TellsAtOnceThatWhatTheSensorToldOfItsAnglesContradictsItself) {
  counters.status.packets_held_back = 10;
  counters.status.angles_contradicted = true;
  (void)look(milliseconds(100));
  EXPECT_THAT(log.last(), HasSubstr("contradicts itself"));
  EXPECT_THAT(log.last(), HasSubstr("set `source`"));
}

TEST_F(LidarWatchTest, TellsLossRotationRateAndClock) {
  packet(seconds(1));
  counters.status.loss = 0.07;
  counters.status.rpm = 300.0;
  counters.status.clock_fault = true;
  counters.status.clock = {seconds(37), 3.1e-6, seconds(1'767'251'437), seconds(0)};
  EXPECT_EQ(look(seconds(1)), fault::clock);
  ASSERT_EQ(log.lines.size(), 3U);
  EXPECT_THAT(log.lines[0].text, HasSubstr("7.0 % of its packets"));
  EXPECT_THAT(log.lines[1].text, HasSubstr("300 rpm where frame_rate_hz asks for 600"));
  EXPECT_THAT(log.lines[2].text,
              HasSubstr("its clock is 37.0 s ahead of this computer's and gains 3.1 ppm: it runs on TAI, as "
                        "PTP does, not on UTC; the time of reception is used instead"));
}

TEST_F(LidarWatchTest, TellsHowAClockThatFollowsNothingIsHelped) {
  packet(seconds(1));
  counters.status.clock_fault = true;
  counters.status.clock.offset = milliseconds(-3);
  counters.status.clock.reference = ClockReference::none;
  EXPECT_EQ(look(seconds(1)), fault::clock);
  EXPECT_THAT(log.last(),
              HasSubstr("its clock is 3.0 ms behind this computer's; the sensor says that it is not "
                        "synchronised; the time of reception is used instead. Set up GPS on it"));
  EXPECT_THAT(log.last(), Not(HasSubstr("fetch")));

  LidarConfig config = boom();
  config.model = "ouster_os";
  LidarWatch ouster(config, 600.0, log, kStart);
  ouster.update(counters, kStart + seconds(1));
  EXPECT_THAT(log.last(), HasSubstr("Set up PTP or GPS on it and fetch its metadata JSON again"));
}

TEST_F(LidarWatchTest, TellsOfAChangedReturnModeAndOfSectorsLeftOutOnce) {
  packet(seconds(1));
  counters.status.return_mode = ReturnMode::dual;
  counters.status.return_mode_changes = 1;
  counters.status.field_of_view_cut = true;
  EXPECT_EQ(look(seconds(1)), 0);
  ASSERT_EQ(log.lines.size(), 2U);
  EXPECT_THAT(log.lines[0].text, HasSubstr("LiDAR boom: its return mode was changed to dual, 1 time so far"));
  EXPECT_THAT(log.lines[1].text, HasSubstr("LiDAR boom: it leaves sectors out"));
  packet(milliseconds(1200));
  EXPECT_EQ(look(milliseconds(1200)), 0);
  EXPECT_EQ(log.lines.size(), 2U);
}

class PlcWatchTest : public testing::Test {
 protected:
  void poll(LinkOutcome outcome, Nanoseconds t, bool fresh = true, const char* message = "") {
    PlcPoll answer;
    answer.outcome = outcome;
    answer.message = message;
    answer.fresh = fresh;
    answer.requested = answer.answered = kStart + t;
    watch.polled(answer, kStart + t);
  }
  void write(LinkOutcome outcome, Nanoseconds t, ReadBack read_back = ReadBack::not_due) {
    PlcWrite written;
    written.outcome = outcome;
    written.message = "refused";
    written.read_back = read_back;
    written.read_back_message = "somebody else writes there";
    watch.wrote(written, kStart + t);
  }
  Faults standing(Nanoseconds t) { return watch.standing(kStart + t); }

  RecordingLog log;
  PlcWatch watch{plc(milliseconds(500)), log, kStart};
};

TEST_F(PlcWatchTest, AFrozenHeartbeatIsStaleAfterItsTimeout) {
  poll(LinkOutcome::ok, milliseconds(100));
  poll(LinkOutcome::ok, milliseconds(600), false);
  EXPECT_EQ(standing(milliseconds(600)), 0);
  EXPECT_EQ(standing(milliseconds(601)), fault::plc_stale);
  EXPECT_THAT(log.last(), HasSubstr("its heartbeat does not move"));
  poll(LinkOutcome::ok, milliseconds(700));
  EXPECT_EQ(standing(milliseconds(700)), 0);
  EXPECT_THAT(log.last(), HasSubstr("new joint values again"));
}

TEST_F(PlcWatchTest, AnOverduePollIsStaleAlsoWithoutAHeartbeatRegister) {
  PlcWatch bare(plc(Nanoseconds{0}), log, kStart);
  EXPECT_EQ(bare.standing(kStart + milliseconds(250)), 0);
  EXPECT_EQ(bare.standing(kStart + milliseconds(251)), fault::plc_stale);
}

TEST_F(PlcWatchTest, ALostLinkIsRememberedUntilAWriteReachesThePlc) {
  poll(LinkOutcome::ok, milliseconds(0));
  EXPECT_FALSE(watch.link_was_lost());
  poll(LinkOutcome::timeout, milliseconds(20), false, "no answer within 100 ms");
  EXPECT_TRUE(watch.link_was_lost());
  EXPECT_THAT(log.last(), HasSubstr("PLC plc:502: no answer within 100 ms"));
  poll(LinkOutcome::waiting, milliseconds(40), false);
  poll(LinkOutcome::ok, milliseconds(60));
  EXPECT_TRUE(watch.link_was_lost());
  EXPECT_THAT(log.last(), HasSubstr("connected again after 0.0 s"));
  write(LinkOutcome::ok, milliseconds(60));
  EXPECT_FALSE(watch.link_was_lost());
  EXPECT_EQ(log.lines.size(), 2U);
}

TEST_F(PlcWatchTest, AnExceptionReplyIsNoLostLink) {
  poll(LinkOutcome::exception, milliseconds(0), false, "exception 02, illegal address: plc.read.base");
  write(LinkOutcome::exception, milliseconds(0));
  EXPECT_FALSE(watch.link_was_lost());
  ASSERT_EQ(log.lines.size(), 2U);
  EXPECT_THAT(log.lines[0].text, HasSubstr("plc.read.base"));
  EXPECT_THAT(log.lines[1].text, HasSubstr("sees our heartbeat stop"));
}

TEST_F(PlcWatchTest, ARefusedValueStandsAsLongAsTheGateSaysSo) {
  poll(LinkOutcome::ok, milliseconds(0));
  watch.judged({JointGate::Verdict::refused, fault::plc_value, "luff 97.0 deg is above 90.0"}, kStart);
  EXPECT_EQ(standing(milliseconds(1)), fault::plc_value);
  EXPECT_THAT(log.last(), HasSubstr("luff 97.0 deg"));
  watch.judged({JointGate::Verdict::believed, 0, ""}, kStart + milliseconds(20));
  EXPECT_EQ(standing(milliseconds(21)), 0);
}

TEST_F(PlcWatchTest, ValuesThatWaitForAPersonSaySoOnceAndWhatToDo) {
  poll(LinkOutcome::ok, milliseconds(0));
  const JointGate::Outcome trial{JointGate::Verdict::on_trial, fault::plc_value, "on trial", false};
  watch.judged(trial, kStart);
  EXPECT_EQ(standing(milliseconds(1)), fault::plc_value);
  EXPECT_TRUE(log.lines.empty()) << "half a second after any gap";
  const JointGate::Outcome wait{JointGate::Verdict::on_trial, fault::plc_value,
                                "joint values wait for a re-acquire edge", true};
  watch.judged(wait, kStart + seconds(1));
  watch.judged(wait, kStart + seconds(2));
  ASSERT_EQ(log.lines.size(), 1U);
  EXPECT_THAT(log.last(), HasSubstr("joint values wait for a re-acquire edge"));
  EXPECT_THAT(log.last(), HasSubstr("check that travel, slew and luff are right, then set command bit 1"));
  watch.judged({JointGate::Verdict::believed, 0, "", false}, kStart + seconds(31));
  EXPECT_THAT(log.last(), HasSubstr("believed again after a wait of 30.0 s"));
}

TEST_F(PlcWatchTest, WithoutACommandWordARestartIsTheRemedy) {
  PlcConfig mute = plc(milliseconds(500));
  mute.read.command = -1;
  PlcWatch bare(mute, log, kStart);
  bare.judged({JointGate::Verdict::on_trial, fault::plc_value, "wait", true}, kStart);
  EXPECT_THAT(log.last(), HasSubstr("then restart the service"));
}

TEST_F(PlcWatchTest, ABusyPlcRefusesNothing) {
  PlcPoll answer;
  answer.outcome = LinkOutcome::exception;
  answer.exception = kExceptionBusy;
  answer.message = "reading holding registers 0 to 7 (plc.read): exception 06, busy";
  watch.polled(answer, kStart);
  EXPECT_TRUE(log.lines.empty());
  EXPECT_EQ(standing(milliseconds(501)), fault::plc_stale);
  EXPECT_THAT(log.last(), HasSubstr("no new pose; reading holding registers 0 to 7"));
}

TEST_F(PlcWatchTest, AForeignHandInOurRegistersIsTold) {
  write(LinkOutcome::ok, milliseconds(0), ReadBack::matches);
  EXPECT_TRUE(log.lines.empty());
  write(LinkOutcome::ok, seconds(1), ReadBack::overwritten);
  EXPECT_THAT(log.last(), HasSubstr("somebody else writes there"));
  write(LinkOutcome::ok, seconds(2), ReadBack::matches);
  EXPECT_EQ(log.lines.size(), 2U);
}

}  // namespace
}  // namespace hulltrack
