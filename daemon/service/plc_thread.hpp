// The thread that talks to the PLC: joints in at every poll, registers out at every frame and heartbeat.
//
// Writes before anything else: what the registers still say may be of a service that died.
// Polls on a fixed grid of poll_period, writes at once when a frame is done and never less often than
// write_period. It computes the age of the pose and takes the health away by itself (publication.hpp), so
// that a stuck tracker can never look healthy. An unreachable PLC costs nothing but its response timeout.
// When asked to stop as a service it writes health 0, state 7 last, also after an exception (farewell.hpp).
// Thread rule: run() in a thread of its own.
#pragma once

#include <atomic>
#include <stop_token>
#include <string>

#include "daemon/config/config.hpp"
#include "daemon/log/state_log.hpp"
#include "daemon/pipeline/command_word.hpp"
#include "daemon/pipeline/plc_watch.hpp"
#include "daemon/pipeline/publication.hpp"
#include "daemon/service/exchange.hpp"
#include "daemon/threads/thread_watch.hpp"
#include "plc/plc_client.hpp"

namespace hulltrack {

/// What the registers say, for the next session to go on from: a reload is no restart for the PLC.
struct RegisterMemory {
  std::uint16_t heartbeat = 0;  // the last one written
  Publication publication{Nanoseconds{0}};
  CommandLatch command;
};

/// A turn of the thread that takes longer is a hang.
[[nodiscard]] Nanoseconds plc_turn_limit(const PlcConfig& plc);

class PlcThread {
 public:
  /// Does not connect. References must outlive this object. `before`: of the session before, if any.
  PlcThread(const Config& config, Exchange& exchange, Pulse& pulse, LogSink& log,
            const RegisterMemory& before);

  void run(std::stop_token stop);

  /// A reload: somebody else goes on writing, so the last write does not say "stopped".
  void leave_without_farewell() { last_write_says_stopped_ = false; }

  // Once run() has returned:
  [[nodiscard]] RegisterMemory memory() const { return {client_.heartbeat(), publication_, command_}; }
  /// How the last write, which says "stopped", went.
  [[nodiscard]] const PlcWrite& farewell() const { return farewell_; }

 private:
  void poll();
  void take_reading(const PlcPoll& poll);
  void take_frame();
  /// False: the PLC was busy.
  bool write(bool stopped);
  [[nodiscard]] PublicationContext context(bool stopped, SteadyTime now) const;
  void publish_view(SteadyTime now);
  void note_write(const PlcWrite& written);

  Exchange& exchange_;
  Pulse& pulse_;
  PlcConfig config_;
  PlcClient client_;
  JointGate gate_;
  Publication publication_;
  CommandLatch command_;
  LogSink& log_;
  PlcWatch watch_;
  StateLog state_log_;
  PlcView view_;
  std::uint64_t frame_sequence_ = 0;
  std::string told_top_;                // the keys of the quay's top that were told last
  std::optional<FrameDone> unwritten_;  // the newest frame, until it stands in the registers
  std::string reason_;                  // the newest frame's
  SteadyTime last_written_{};
  std::atomic<bool> last_write_says_stopped_ = true;
  PlcWrite farewell_;
};

}  // namespace hulltrack
