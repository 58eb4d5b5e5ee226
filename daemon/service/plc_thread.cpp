#include "daemon/service/plc_thread.hpp"

#include <algorithm>

#include "daemon/config/conversions.hpp"
#include "daemon/pipeline/found_top.hpp"
#include "daemon/pipeline/joint_gate_config.hpp"
#include "daemon/pipeline/live_time.hpp"
#include "daemon/pipeline/plc_reading.hpp"
#include "daemon/service/farewell.hpp"

namespace hulltrack {
namespace {

/// A heartbeat is written this much before it is due, so that a poll in progress does not make it late.
constexpr Nanoseconds kWriteMargin = std::chrono::milliseconds(10);
/// rx looks at the LiDARs every 20 ms; after this long without a look nothing is known of them.
constexpr Nanoseconds kLidarViewAge = std::chrono::seconds(1);

/// The next point of a grid after `now`; turns that were missed are left out.
SteadyTime next_on_grid(SteadyTime due, Nanoseconds period, SteadyTime now) {
  return now < due + period ? due + period : due + ((now - due) / period + 1) * period;
}

}  // namespace

/// Besides, a turn may wait for three replies: poll, read-back, write.
Nanoseconds plc_turn_limit(const PlcConfig& plc) { return kTurnLimit + 3 * plc.response_timeout; }

PlcThread::PlcThread(const Config& config, Exchange& exchange, Pulse& pulse, LogSink& log,
                     const RegisterMemory& before)
    : exchange_(exchange),
      pulse_(pulse),
      config_(config.plc),
      client_(config.plc, {}, before.heartbeat),
      gate_(joint_gate_config(config.plc)),
      publication_(before.publication),
      command_(before.command),
      log_(log),
      watch_(config.plc, log, steady_now()),
      state_log_(log) {
  publication_.begin_anew(config.tracker.health.max_age);
}

void PlcThread::run(std::stop_token stop) {
  try {
    SteadyTime next_poll = steady_now();
    SteadyTime next_write = next_poll;
    const Nanoseconds write_gap = config_.write_period - std::min(kWriteMargin, config_.write_period / 4);
    while (!stop.stop_requested()) {
      take_frame();
      if (const SteadyTime now = steady_now(); unwritten_ || now >= next_write) {
        // A PLC that is busy for a moment hears of us at the next poll, not a whole period later.
        next_write = now + (write(false) ? write_gap : std::min(write_gap, config_.poll_period));
      }
      if (const SteadyTime now = steady_now(); now >= next_poll) {
        poll();
        next_poll = next_on_grid(next_poll, config_.poll_period, now);
      }
      const SteadyTime now = steady_now();
      pulse_.beat(now);
      publish_view(now);
      exchange_.plc_bell.wait_until(std::min(next_poll, next_write));
    }
  } catch (...) {
    write(true);
    throw;
  }
  write(last_write_says_stopped_);  // else the gap until somebody goes on begins here, not up to a period ago
}

void PlcThread::poll() {
  const PlcPoll answer = client_.poll();
  const SteadyTime now = steady_now();
  watch_.polled(answer, now);
  if (answer.ok()) {
    take_reading(answer);
  }
  Figures figures;
  figures.polls = 1;
  figures.polls_failed = answer.ok() ? 0 : 1;
  if (answer.ok()) {
    figures.round_trip_ms.add(to_milliseconds(answer.answered - answer.requested));
  }
  exchange_.figures.add(figures);
}

void PlcThread::take_reading(const PlcPoll& answer) {
  const PlcReading& reading = answer.reading;
  if (reading.torn) {
    return;
  }
  JointSample sample{live_measurement_time(answer.stamp() - config_.latency),
                     joints_from_plc(reading.travel_m, reading.slew_deg, reading.luff_deg)};
  const JointGate::Outcome outcome =
      take_plc_reading({sample, reading.heartbeat}, reading.command, command_, gate_);
  if (outcome.verdict == JointGate::Verdict::no_news) {
    return;
  }
  if (command_.take_reacquire()) {
    ++view_.reacquire_edges;
  }
  watch_.judged(outcome, answer.answered);
  view_.joint_trouble = outcome.reason;
  publish_view(answer.answered);  // before the sample: a frame must not be judged by an older view
  sample.on_trial = outcome.verdict == JointGate::Verdict::on_trial;
  if (outcome.verdict != JointGate::Verdict::refused) {
    exchange_.joints.push(sample);
    exchange_.track_bell.ring();
  }
}

void PlcThread::take_frame() {
  FrameDone frame = exchange_.frame.get();
  if (frame.sequence == frame_sequence_) {
    return;
  }
  frame_sequence_ = frame.sequence;
  reason_ = frame.result.reason;
  gate_.frame_done(frame.first_firing, frame.last_firing, frame.result.joints_confirmed);
  publication_.frame(frame.result, live_measurement_time(steady_now()), frame.done - frame.last_received);
  if (const auto& top = frame.result.found_top; top && quay_keys(*top) != told_top_) {
    told_top_ = quay_keys(*top);
    log_.write(LogLevel::notice, describe_found_top(*top));
  }
  unwritten_ = std::move(frame);
}

PublicationContext PlcThread::context(bool stopped, SteadyTime now) const {
  const LidarView lidars = exchange_.lidars.get();
  const bool known = lidars.updated == SteadyTime{} || now - lidars.updated < kLidarViewAge;
  return {.stopped = stopped,
          .out_of_service = exchange_.out_of_service,
          .every_lidar_silent = lidars.every_silent || !known,
          .standing = static_cast<Faults>(lidars.standing | view_.standing),
          .command = command_.command()};
}

void PlcThread::publish_view(SteadyTime now) {
  view_.hold = command_.hold();
  view_.standing = watch_.standing(now);
  exchange_.plc.put(view_);
}

bool PlcThread::write(bool stopped) {
  const SteadyTime now = steady_now();
  Faults events = exchange_.events.collect();
  if (watch_.link_was_lost()) {
    events |= fault::plc_link_lost;
  }
  publication_.events(events, live_measurement_time(now));
  view_.standing = watch_.standing(now);
  const WriteBlock block = publication_.block(context(stopped, now), live_measurement_time(now));
  const PlcWrite written = stopped ? write_farewell(client_, block) : client_.write(block);
  if (stopped) {
    farewell_ = written;
  }
  watch_.wrote(written, steady_now());
  exchange_.registers.put(block);
  state_log_.update(block, reason_, now);
  note_write(written);
  if (unwritten_ && block.health) {
    Figures healthy;
    healthy.healthy_frames = 1;
    exchange_.figures.add(healthy);
  }
  unwritten_.reset();
  return written.exception != kExceptionBusy;
}

void PlcThread::note_write(const PlcWrite& written) {
  Figures figures;
  if (!written.ok()) {
    figures.writes_failed = 1;
  } else {
    if (last_written_ != SteadyTime{}) {
      figures.write_gap_ms.add(to_milliseconds(written.answered - last_written_));
    }
    last_written_ = written.answered;
    if (unwritten_) {
      figures.latency_ms.add(to_milliseconds(written.answered - unwritten_->last_received));
    }
  }
  exchange_.figures.add(figures);
}

}  // namespace hulltrack
