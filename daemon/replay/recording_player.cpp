#include "daemon/replay/recording_player.hpp"

#include <algorithm>

#include "core/base/text.hpp"
#include "daemon/config/conversions.hpp"
#include "daemon/pipeline/joint_gate_config.hpp"
#include "daemon/pipeline/plc_reading.hpp"

namespace hulltrack {

Result<void> check_recording_folder(const std::filesystem::path& folder) {
  std::error_code failure;
  if (!std::filesystem::is_directory(folder, failure)) {
    return Error{folder.string() + ": is no folder; name the folder that holds lidar.pcap and plc.csv"};
  }
  for (const char* name : {"lidar.pcap", "plc.csv"}) {
    if (!std::filesystem::exists(folder / name, failure)) {
      return Error{(folder / name).string() +
                   ": is missing; a recording folder holds lidar.pcap and plc.csv"};
    }
  }
  return {};
}

Result<std::unique_ptr<RecordingPlayer>> RecordingPlayer::open(const std::filesystem::path& folder,
                                                               const Config& config) {
  if (const Result<void> complete = check_recording_folder(folder); !complete) {
    return complete.error();
  }
  Result<std::vector<PlcCsvRow>> rows = read_plc_csv(folder / "plc.csv");
  if (!rows) {
    return rows.error();
  }
  Result<PcapSource> source = PcapSource::open(folder / "lidar.pcap");
  if (!source) {
    return source.error();
  }
  Result<DatagramRouter> router = DatagramRouter::create(config.lidars);
  if (!router) {
    return router.error();
  }
  Result<ScanBuilder> builder = ScanBuilder::create(config.lidars, config.framing);
  if (!builder) {
    return builder.error();
  }
  return std::unique_ptr<RecordingPlayer>(
      new RecordingPlayer(folder, config, std::move(source).value(), std::move(router).value(),
                          std::move(builder).value(), std::move(rows).value()));
}

RecordingPlayer::RecordingPlayer(const std::filesystem::path& folder, const Config& config,
                                 PcapSource&& source, DatagramRouter&& router, ScanBuilder&& builder,
                                 std::vector<PlcCsvRow>&& rows)
    : pcap_name_((folder / "lidar.pcap").string()),
      plc_name_((folder / "plc.csv").string()),
      lidars_(config.lidars),
      trouble_(config.lidars.size()),
      plc_(config.plc),
      source_(std::move(source)),
      router_(std::move(router)),
      builder_(std::move(builder)),
      rows_(std::move(rows)),
      gate_(joint_gate_config(config.plc)),
      news_(config.plc, measurement_time_from_ns(rows_.front().t_ns)) {}

Result<bool> RecordingPlayer::next(Scan& scan) {
  Result<bool> frame = read_until_frame(scan);
  if (!frame || !*frame) {
    return frame;
  }
  any_frame_ = true;
  play_plc_until(scan.segments.empty() ? scan.end : scan.last_firing);
  played_ = scan.end;
  inputs_.hold = latch_.hold();
  inputs_.reacquire = latch_.take_reacquire();
  first_firing_ = scan.first_firing;
  last_firing_ = scan.last_firing;
  if (value_fault_ != 0) {
    ++doubtful_;
    last_doubt_ = inputs_.joint_trouble;
  }
  context_ = {.standing = value_fault_, .command = latch_.command()};
  // Rows are played until one brackets the last firing: what comes later is not news yet.
  const MeasurementTime played_until = scan.segments.empty() ? scan.end : scan.last_firing;
  context_.standing |= news_.is_stale(played_until) ? fault::plc_stale : Faults{0};
  look_at_lidars(scan.end);
  inputs_.standing = context_.standing;
  return true;
}

Result<bool> RecordingPlayer::read_until_frame(Scan& scan) {
  while (!builder_.take(scan)) {
    if (at_end_) {
      return any_frame_ ? Result<bool>(false)
                        : Error{pcap_name_ +
                                ": holds no complete frame, less than one turn of the LiDAR; record longer"};
    }
    Datagram datagram;
    const Result<bool> more = source_.next(datagram);
    if (!more) {
      return more;
    }
    if (!*more) {
      at_end_ = true;
      if (std::string nothing = explain_no_frame(); !nothing.empty()) {
        return Error{std::move(nothing)};
      }
      if (joints_time(rows_.front()) > last_datagram_) {
        return Error{explain_no_joints()};
      }
      builder_.finish();
      continue;
    }
    if (const auto lidar = router_.lidar_of(datagram)) {
      last_datagram_ = datagram.received;
      if (datagrams_++ == 0) {
        first_datagram_ = datagram.received;
        if (joints_time(rows_.back()) < first_datagram_) {
          return Error{explain_no_joints()};
        }
      }
      if (builder_.takes(*lidar, datagram)) {
        builder_.add(*lidar, datagram);
      }
    }
  }
  return true;
}

/// Adds to the context how the LiDARs stand.
void RecordingPlayer::look_at_lidars(MeasurementTime now) {
  context_.every_lidar_silent = true;
  for (std::size_t i = 0; i < lidars_.size(); ++i) {
    const LidarStatus status = builder_.status(i);
    const bool silent = silence_of(status, first_datagram_, now) > lidars_[i].timeout;
    trouble_[i].silent += silent ? 1 : 0;
    trouble_[i].clock += status.clock_fault ? 1 : 0;
    if (status.clock_fault) trouble_[i].last_clock = status.clock;
    context_.standing |= standing_of(status, silent);
    context_.every_lidar_silent = context_.every_lidar_silent && silent;
  }
}

std::string RecordingPlayer::explain_lidars() const {
  std::string text;
  for (std::size_t i = 0; i < lidars_.size(); ++i) {
    const Trouble& trouble = trouble_[i];
    const char* name = lidars_[i].name.c_str();
    if (const std::string two = builder_.two_senders(i); !two.empty()) {
      text +=
          format_text("senders     LiDAR %s: %s; set `source` to the one that is meant\n", name, two.c_str());
    }
    if (trouble.silent > 0) {
      text += format_text("silent      LiDAR %s for longer than %lld ms in %s\n", name,
                          static_cast<long long>(lidars_[i].timeout / std::chrono::milliseconds(1)),
                          counted(trouble.silent, "frame").c_str());
    }
    if (trouble.clock > 0) {
      text += format_text("clock       of LiDAR %s not used in %s: %s\n", name,
                          counted(trouble.clock, "frame").c_str(), clock_words(trouble.last_clock).c_str());
    }
  }
  return text;
}

/// Why the capture, read to its end, holds no frame at all; empty if it does.
std::string RecordingPlayer::explain_no_frame() const {
  if (datagrams_ == 0) {
    std::string ports;
    for (const LidarConfig& lidar : lidars_) {
      ports += (ports.empty() ? "" : ", ") + std::to_string(lidar.port);
      ports += lidar.source.empty() ? "" : " from " + lidar.source;
    }
    return source_.explain_nothing_found(" for any [[lidar]] (UDP port " + ports + ")") +
           "; correct its port or source, or record the network interface that the LiDAR is on";
  }
  for (std::size_t i = 0; i < lidars_.size(); ++i) {
    if (builder_.status(i).packets > 0) {
      return {};
    }
  }
  for (std::size_t i = 0; i < lidars_.size(); ++i) {
    if (const LidarStatus status = builder_.status(i); status.packets_rejected > 0) {
      return pcap_name_ + ": none of " + std::to_string(status.packets_rejected) +
             " datagrams is of lidar \"" + lidars_[i].name + "\", a " + lidars_[i].model + ": " +
             builder_.last_rejection(i) + "; correct its model or port";
    }
  }
  return {};
}

MeasurementTime RecordingPlayer::joints_time(const PlcCsvRow& row) const {
  return measurement_time_from_ns(row.t_ns) - plc_.latency;
}

/// The two files do not speak of the same time, so that no frame can have joints.
std::string RecordingPlayer::explain_no_joints() const {
  const bool before = joints_time(rows_.back()) < first_datagram_;
  const Nanoseconds apart =
      before ? first_datagram_ - joints_time(rows_.back()) : joints_time(rows_.front()) - last_datagram_;
  return plc_name_ + ": its rows lie " + format_text("%.1f s ", to_seconds(apart)) +
         (before ? "before" : "after") + " the datagrams of " + pcap_name_ +
         "; both must be of one recording, stamped by one clock in UTC nanoseconds";
}

void RecordingPlayer::play_plc_until(MeasurementTime last_firing) {
  const auto bracketed = [&] { return joints_.newest() && joints_.newest()->time >= last_firing; };
  while (next_row_ < rows_.size() && !bracketed()) {
    const PlcCsvRow& row = rows_[next_row_];
    if (joints_time(row) > last_firing + JointHistory::kMaxGap) {
      return;
    }
    play_row(row);
    ++next_row_;
  }
}

void RecordingPlayer::play_row(const PlcCsvRow& row) {
  const MeasurementTime presented = measurement_time_from_ns(row.t_ns);
  JointSample sample{presented - plc_.latency, joints_from_plc(row.d_x, row.theta_r_deg, row.theta_p_deg)};
  const JointGate::Outcome outcome =
      take_plc_reading({sample, static_cast<std::uint16_t>(row.heartbeat)}, row.command, latch_, gate_);
  value_fault_ = outcome.faults;
  inputs_.joint_trouble = outcome.reason;
  if (outcome.verdict != JointGate::Verdict::no_news) {
    news_.heard(presented);
  }
  sample.on_trial = outcome.verdict == JointGate::Verdict::on_trial;
  if (outcome.verdict == JointGate::Verdict::believed || sample.on_trial) {
    joints_.add(sample);
  }
}

void RecordingPlayer::judged(const TrackResult& result) {
  gate_.frame_done(first_firing_, last_firing_, result.joints_confirmed);
}

std::string RecordingPlayer::explain_joints() const {
  return doubtful_ == 0 ? std::string{}
                        : format_text("joints      not believed in %s: %s\n",
                                      counted(doubtful_, "frame").c_str(), last_doubt_.c_str());
}

double RecordingPlayer::share() const {
  const double span = static_cast<double>(rows_.back().t_ns - rows_.front().t_ns);
  const double played = static_cast<double>(to_ns(played_) - rows_.front().t_ns);
  return span > 0.0 ? std::clamp(played / span, 0.0, 1.0) : 1.0;
}

}  // namespace hulltrack
