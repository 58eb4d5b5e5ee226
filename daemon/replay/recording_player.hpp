// A recording folder, frame by frame, as the service would have seen it.
//
// lidar.pcap goes through the router, the decoders and the scan builder; plc.csv through the joint gate and
// the command latch, up to the sample that brackets a frame or 250 ms beyond it. The recording's UTC stamps
// are the measurement time. Deterministic. Failure: one line with the file and what to do. Thread rule: one
// owner. Memory: plc.csv as a whole, one frame of LiDAR data at a time.
#pragma once

#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "core/base/result.hpp"
#include "core/io/plc_csv.hpp"
#include "core/tracking/hull_tracker.hpp"
#include "daemon/config/config.hpp"
#include "daemon/pipeline/command_word.hpp"
#include "daemon/pipeline/joint_gate.hpp"
#include "daemon/pipeline/publication.hpp"
#include "daemon/pipeline/standing.hpp"
#include "lidar_drivers/datagram_router.hpp"
#include "lidar_drivers/pcap_source.hpp"
#include "lidar_drivers/scan_builder.hpp"

namespace hulltrack {

/// Whether `folder` holds what a recording is made of; an error says what is missing.
[[nodiscard]] Result<void> check_recording_folder(const std::filesystem::path& folder);

class RecordingPlayer {
 public:
  /// `config` is copied as far as it is needed.
  [[nodiscard]] static Result<std::unique_ptr<RecordingPlayer>> open(const std::filesystem::path& folder,
                                                                     const Config& config);

  /// True: `scan` is the next frame, and joints() and inputs() hold what the PLC had said by then.
  /// False: the recording is at its end. An error: it breaks off here.
  [[nodiscard]] Result<bool> next(Scan& scan);

  [[nodiscard]] const JointHistory& joints() const { return joints_; }
  [[nodiscard]] const FrameInputs& inputs() const { return inputs_; }
  /// What surrounds that frame for the registers, at the end of its scan.
  [[nodiscard]] const PublicationContext& context() const { return context_; }

  /// What the tracker made of the frame that next() gave last.
  void judged(const TrackResult& result);

  /// In how many frames joint values were not believed and why at last, a line for the terminal; empty if in
  /// none.
  [[nodiscard]] std::string explain_joints() const;

  /// Which LiDARs fell silent, had a clock that was not believed or company on their port in the frames so
  /// far, a line each for the terminal; empty if none did.
  [[nodiscard]] std::string explain_lidars() const;

  /// How much of the recording's time has been played, 0..1.
  [[nodiscard]] double share() const;

 private:
  RecordingPlayer(const std::filesystem::path& folder, const Config& config, PcapSource&& source,
                  DatagramRouter&& router, ScanBuilder&& builder, std::vector<PlcCsvRow>&& rows);
  [[nodiscard]] Result<bool> read_until_frame(Scan& scan);
  /// In how many frames a LiDAR had it.
  struct Trouble {
    std::uint64_t silent = 0;
    std::uint64_t clock = 0;
    ClockReading last_clock{};  // the newest that was not believed
  };

  void look_at_lidars(MeasurementTime now);
  [[nodiscard]] std::string explain_no_frame() const;
  [[nodiscard]] std::string explain_no_joints() const;
  /// When the joints of `row` were measured.
  [[nodiscard]] MeasurementTime joints_time(const PlcCsvRow& row) const;
  void play_plc_until(MeasurementTime last_firing);
  void play_row(const PlcCsvRow& row);

  std::string pcap_name_, plc_name_;
  std::vector<LidarConfig> lidars_;
  std::vector<Trouble> trouble_;  // one a LiDAR
  PlcConfig plc_;
  PcapSource source_;
  DatagramRouter router_;
  ScanBuilder builder_;
  bool at_end_ = false;
  bool any_frame_ = false;
  std::uint64_t datagrams_ = 0;  // for one of the LiDARs
  MeasurementTime first_datagram_{}, last_datagram_{};

  std::vector<PlcCsvRow> rows_;
  std::size_t next_row_ = 0;
  JointGate gate_;
  CommandLatch latch_;
  JointHistory joints_;
  FrameInputs inputs_;
  PublicationContext context_;
  Faults value_fault_ = 0;
  std::uint64_t doubtful_ = 0;  // frames in which joint values were not believed
  std::string last_doubt_;
  MeasurementTime first_firing_{}, last_firing_{};  // of the frame that next() gave last
  PlcNews news_;
  MeasurementTime played_{};
};

}  // namespace hulltrack
