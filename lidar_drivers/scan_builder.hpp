// Datagrams of every LiDAR -> frames: which points were measured in which frame?
//
// Period framing: one grid for all LiDARs, frame k = [t0 + k P, t0 + (k + 1) P), t0 = the first firing of
// the first decoded datagram. Revolution framing: a frame ends when the rotor of the first LiDAR passes zero
// azimuth. Both cut between two firings, inside a datagram or a block if need be; a point is in exactly
// one frame. Frames without a datagram are left out and, with period framing, their numbers skipped.
// Firing times hang on the datagram's receive stamp as it is, unsmoothed; one that was overtaken on the
// way is put where the sensor's clock says. Bytes are untrusted: nothing throws, memory is bounded.
// Owner: one thread.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "core/base/result.hpp"
#include "core/geometry/scan.hpp"
#include "lidar_drivers/datagram.hpp"
#include "lidar_drivers/decoder.hpp"
#include "lidar_drivers/frame_assembler.hpp"
#include "lidar_drivers/lidar_config.hpp"
#include "lidar_drivers/packet_sequence.hpp"
#include "lidar_drivers/sender_lock.hpp"
#include "lidar_drivers/sensor_clock.hpp"

namespace hulltrack {

/// What is known of one LiDAR. Counters run from the start.
struct LidarStatus {
  std::uint64_t packets = 0;             // decoded, duplicates included
  std::uint64_t packets_rejected = 0;    // not this model's datagrams; see last_rejection
  std::uint64_t packets_of_another = 0;  // from a second sensor on the port, where `source` is empty: dropped
  bool disputed = false;                 // by it: nobody can say which of the two is meant
  std::uint64_t packets_held_back = 0;   // not decodable before the sensor tells its angles
  bool angles_contradicted = false;  // of the newest one held back: what the sensor told contradicts itself
  std::uint64_t informations = 0;    // datagrams without points: what the sensor tells of itself, its IMU
  std::uint64_t packets_lost = 0;    // missing between the sensor's time stamps
  std::uint64_t packets_duplicate = 0;  // the same bytes again: dropped
  std::uint64_t packets_out_of_order = 0;
  std::uint64_t points_late = 0;          // their frame had been handed out: dropped
  std::uint64_t points_over_limit = 0;    // beyond kMaxLidarPoints: dropped
  std::uint64_t points_out_of_range = 0;  // farther than the model measures: dropped
  std::uint64_t return_mode_changes = 0;
  std::uint64_t clock_restarts = 0;  // the sensor's clock jumped: reboot, or time synchronisation
  ReturnMode return_mode = ReturnMode::unknown;
  bool field_of_view_cut = false;  // the sensor leaves sectors out
  double rpm = 0.0;
  double packets_per_second = 0.0;  // over the last whole second of this LiDAR's stamps
  double loss = 0.0;                // 0..1, over the same second
  MeasurementTime last_received{};  // of a decoded datagram; meaningless while packets == 0
  bool clock_fault = false;         // time_source sensor: its clock is not believed, host time is used
  ClockReading clock{};             // of the sensor
};

class ScanBuilder {
 public:
  /// An error names the LiDAR and what is wrong with it (unknown model, unreadable calibration).
  /// framing.frame_rate_hz in (0, 1000].
  [[nodiscard]] static Result<ScanBuilder> create(const std::vector<LidarConfig>& lidars,
                                                  const FramingConfig& framing);

  ScanBuilder(ScanBuilder&&) noexcept = default;
  ScanBuilder& operator=(ScanBuilder&&) noexcept = default;

  /// Whether a datagram of LiDAR `lidar` comes from the sensor whose datagrams are taken (sender_lock.hpp);
  /// ask before each add(). What another sensor sent counts as foreign in the frame.
  [[nodiscard]] bool takes(std::size_t lidar, const Datagram& datagram);

  /// Decodes one datagram of LiDAR `lidar` (index of the configuration's list) and sorts its points in, or
  /// takes in what it tells about the sensor.
  DecodeOutcome add(std::size_t lidar, const Datagram& datagram);

  /// Finishes frames that ended more than 20 ms before `now` although nothing more arrived. `now` is on the
  /// clock of the stamps: live, read it before draining the sources, or what still waits there comes late.
  void advance(MeasurementTime now);

  /// The recording is at its end: finishes what is open. Revolution framing leaves an unfinished turn out.
  void finish();

  /// Hands out the oldest finished frame by swapping: `out`'s old buffers are used again. False when there
  /// is none. `out.last_received` is left zero: the service, which alone knows the live clock, sets it.
  bool take(Scan& out);

  /// Figures alone, cheap to ask for.
  [[nodiscard]] LidarStatus status(std::size_t lidar) const;
  /// Expected, seen and sender of the newest refused datagram, for the log; empty while there was none.
  [[nodiscard]] std::string last_rejection(std::size_t lidar) const;
  /// "two sensors send to UDP port 2368: 192.168.1.201 and 192.168.1.202"; empty while there was one.
  [[nodiscard]] std::string two_senders(std::size_t lidar) const;
  /// Finished frames that nobody took in time (the newest four are kept).
  [[nodiscard]] std::uint64_t frames_overrun() const { return frames_.frames_overrun(); }
  /// How often the stamps ran back by seconds, as in a recording across a clock that was set.
  [[nodiscard]] std::uint64_t clock_steps() const { return frames_.clock_steps(); }

 private:
  /// One second of stamps, for rates.
  struct RateWindow {
    MeasurementTime begin{};
    std::uint64_t packets = 0;
    std::uint64_t lost = 0;
  };
  struct Lidar {
    LidarConfig config;
    double range = 0.0;  // m, the model's
    std::unique_ptr<Decoder> decoder;
    PacketSequence sequence;
    SensorClock clock;
    SenderLock sender;
    LidarStatus status{};
    DecodeOutcome last_rejection{};
    std::uint32_t rejected_ip = 0;
    std::uint16_t rejected_port = 0;
    MeasurementTime newest{};  // last firing of the newest datagram
    double newest_azimuth = 0.0;
    std::optional<MeasurementTime> last_crossing{};
    RateWindow window{};
  };

  ScanBuilder(std::vector<Lidar> lidars, const FramingConfig& framing);
  void note_sequence(std::size_t index, const PacketSequence::Step& step);
  void note_packet(Lidar& lidar, MeasurementTime time);
  [[nodiscard]] static MeasurementTime host_or_sensor_time(Lidar& lidar, const DecodedPacket& packet,
                                                           const Datagram& datagram);
  [[nodiscard]] std::optional<MeasurementTime> zero_crossing(const Lidar& lidar, MeasurementTime last) const;
  void drop_out_of_range(Lidar& lidar);

  Framing framing_;
  std::vector<Lidar> lidars_;
  FrameAssembler frames_;
  DecodedPacket packet_;  // scratch
};

}  // namespace hulltrack
