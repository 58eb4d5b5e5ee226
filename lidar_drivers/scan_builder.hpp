// Datagrams of every LiDAR -> frames: which points were measured in which frame?
//
// Period framing: one grid for all LiDARs, frame k = [t0 + k P, t0 + (k + 1) P), t0 = the first firing of
// the first decoded datagram. Revolution framing: a frame ends when the rotor of the first LiDAR passes
// zero azimuth. Both cut between two firings, inside a datagram or a block if need be; a point is in
// exactly one frame. Frames without a datagram are left out and their numbers skipped.
// A frame is finished when every LiDAR that is sending has delivered beyond its end; what comes for it later
// is counted and dropped. Bytes are untrusted: nothing throws, memory is bounded. Owner: one thread.
#pragma once

#include <cstdint>
#include <deque>
#include <memory>
#include <string>
#include <vector>

#include "core/base/result.hpp"
#include "core/geometry/scan.hpp"
#include "lidar_drivers/datagram.hpp"
#include "lidar_drivers/decoder.hpp"
#include "lidar_drivers/lidar_config.hpp"
#include "lidar_drivers/packet_sequence.hpp"

namespace hulltrack {

/// More points than this in one frame are counted and dropped.
inline constexpr std::size_t kMaxScanPoints = 500'000;

/// What is known of one LiDAR. Counters run from the start.
struct LidarStatus {
  std::uint64_t packets = 0;            // decoded, duplicates included
  std::uint64_t packets_rejected = 0;   // not this model's datagrams; see last_rejection
  std::uint64_t packets_lost = 0;       // missing between the sensor's time stamps
  std::uint64_t packets_duplicate = 0;  // the same bytes again: dropped
  std::uint64_t packets_out_of_order = 0;
  std::uint64_t points_late = 0;        // their frame had been handed out: dropped
  std::uint64_t points_over_limit = 0;  // beyond kMaxScanPoints: dropped
  std::uint64_t return_mode_changes = 0;
  std::uint64_t clock_restarts = 0;  // the sensor's clock jumped: reboot, or time synchronisation
  ReturnMode return_mode = ReturnMode::unknown;
  bool field_of_view_cut = false;  // the sensor leaves sectors out
  double rpm = 0.0;
  double packets_per_second = 0.0;  // over the last whole second of this LiDAR's stamps
  double loss = 0.0;                // 0..1, over the same second
  MeasurementTime last_received{};  // of a decoded datagram; meaningless while packets == 0
  bool clock_fault = false;         // time_source sensor: sensor and host disagree, host time is used
  Nanoseconds clock_offset{};       // sensor minus host time modulo the sensor's wrap, time_source sensor
  std::string last_rejection;       // names expected and seen; empty while packets_rejected == 0
};

class ScanBuilder {
 public:
  /// An error names the LiDAR and what is wrong with it (unknown model, unreadable calibration).
  /// framing.frame_rate_hz in (0, 1000].
  [[nodiscard]] static Result<ScanBuilder> create(const std::vector<LidarConfig>& lidars,
                                                  const FramingConfig& framing);

  ScanBuilder(ScanBuilder&&) noexcept = default;
  ScanBuilder& operator=(ScanBuilder&&) noexcept = default;

  /// Decodes one datagram of LiDAR `lidar` (index of the configuration's list) and sorts its points in.
  DecodeOutcome add(std::size_t lidar, const Datagram& datagram);

  /// Counts of the receiver since the last call, for the counters of the frame that is being filled.
  void add_receive_counts(std::size_t lidar, std::uint32_t foreign, std::uint32_t kernel_overflows);

  /// Finishes frames whose time is over although nothing more arrived. `now` on the clock of the stamps.
  void advance(MeasurementTime now);

  /// The recording is at its end: finishes what is open.
  void finish();

  /// Hands out the oldest finished frame by swapping: `out`'s old buffers are used again. False when there
  /// is none. `out.last_received` is left zero: the service, which alone knows the live clock, sets it.
  bool take(Scan& out);

  [[nodiscard]] LidarStatus status(std::size_t lidar) const;
  /// Finished frames that nobody took in time (the newest four are kept).
  [[nodiscard]] std::uint64_t frames_overrun() const { return frames_overrun_; }

 private:
  struct Lidar {
    LidarConfig config;
    std::unique_ptr<Decoder> decoder;
    PacketSequence sequence;
    LidarStatus status;
    DecodeOutcome last_rejection;
    MeasurementTime newest{};  // last firing delivered so far
    MeasurementTime last_crossing{};
    double last_azimuth = 0.0;
    MeasurementTime second_begin{};
    std::uint64_t second_packets = 0;
    std::uint64_t second_lost = 0;
  };
  struct Frame {
    Scan scan;
    bool used = false;
  };

  ScanBuilder(Framing framing, Nanoseconds period);
  void begin_frames(MeasurementTime start);
  void make_room(MeasurementTime first, MeasurementTime last);
  void note_crossing(Lidar& lidar, MeasurementTime first, MeasurementTime last);
  void place(std::size_t lidar, MeasurementTime first, MeasurementTime last);
  void place_part(Frame& frame, std::size_t lidar, MeasurementTime last, MeasurementTime from,
                  MeasurementTime to);
  void close_current();
  void close_complete();
  void open(Frame& frame, std::uint32_t number, MeasurementTime begin);
  [[nodiscard]] MeasurementTime measuring_time(Lidar& lidar, const Datagram& datagram);
  void update_rates(Lidar& lidar, MeasurementTime time, std::uint64_t lost);

  Framing framing_;
  Nanoseconds period_;  // revolution framing: the longest wait for a crossing
  std::vector<Lidar> lidars_;
  DecodedPacket packet_;  // scratch
  bool started_ = false;
  Frame current_;
  Frame next_;
  std::deque<Scan> finished_;
  std::vector<Scan> spare_;  // buffers to use again
  std::uint64_t frames_overrun_ = 0;
};

}  // namespace hulltrack
