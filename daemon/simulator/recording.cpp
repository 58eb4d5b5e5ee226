#include "daemon/simulator/recording.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <system_error>
#include <utility>

#include "core/io/pcd_writer.hpp"
#include "daemon/simulator/parallel.hpp"
#include "daemon/simulator/random.hpp"
#include "daemon/simulator/site_config.hpp"
#include "lidar_drivers/pcap_writer.hpp"

namespace hulltrack {
namespace {

namespace fs = std::filesystem;

constexpr Nanoseconds kMargin = std::chrono::milliseconds(500);
constexpr Nanoseconds kPollPeriod = std::chrono::milliseconds(20);
constexpr Nanoseconds kTruthPeriod = std::chrono::milliseconds(10);

std::int64_t utc_ns(Nanoseconds time) { return to_ns(SimulatedBerth::kEpoch + time); }

Eigen::Vector3d in_degrees(const Eigen::Vector3d& rpy) {
  return rpy.unaryExpr([](double r) { return degrees(r); });
}

/// Files on their way into a folder: under a temporary name until commit(), gone without it.
class PendingFiles {
 public:
  explicit PendingFiles(fs::path folder) : folder_(std::move(folder)) {}
  PendingFiles(const PendingFiles&) = delete;
  PendingFiles& operator=(const PendingFiles&) = delete;
  ~PendingFiles() {
    std::error_code ignored;
    for (const std::string& name : names_) fs::remove(temporary(name), ignored);
  }

  /// Where to write the file that shall be called `name`.
  fs::path add(const std::string& name) {
    names_.push_back(name);
    return temporary(name);
  }

  Result<void> commit() {
    for (const std::string& name : names_) {
      std::error_code failure;
      fs::rename(temporary(name), folder_ / name, failure);
      if (failure) return Error{(folder_ / name).string() + ": cannot be put in place: " + failure.message()};
    }
    names_.clear();
    return {};
  }

 private:
  [[nodiscard]] fs::path temporary(const std::string& name) const { return folder_ / (name + ".part"); }

  fs::path folder_;
  std::vector<std::string> names_;
};

Result<void> prepare_folder(const fs::path& folder, bool overwrite) {
  std::error_code failure;
  fs::create_directories(folder, failure);
  if (failure) return Error{folder.string() + ": cannot be made: " + failure.message()};
  const bool empty = fs::is_empty(folder, failure);
  if (failure) return Error{folder.string() + ": cannot be read: " + failure.message()};
  if (!empty && !overwrite)
    return Error{folder.string() +
                 ": is not empty; choose another folder, or --force to replace the recording in it"};
  return {};
}

template <typename Row>
Result<void> write_table(const fs::path& file, const std::vector<Row>& rows) {
  auto writer = CsvWriter<Row>::create(file);
  if (!writer) return writer.error();
  for (const Row& row : rows)
    if (auto written = writer->write(row); !written) return written;
  return writer->close();
}

Result<void> write_text(const fs::path& file, const std::string& text) {
  std::FILE* stream = std::fopen(file.c_str(), "wb");
  if (stream == nullptr)
    return Error{file.string() + ": cannot be created: " + std::generic_category().message(errno)};
  const bool written = std::fwrite(text.data(), 1, text.size(), stream) == text.size();
  const bool closed = std::fclose(stream) == 0;
  if (!written || !closed)
    return Error{file.string() + ": cannot be written: " + std::generic_category().message(errno)};
  return {};
}

/// The sensor as delivered: 192.168.1.201 broadcasts.
constexpr UdpEndpoints broadcast_to(std::uint16_t port) {
  return {
      .source_ip = 0xC0A801C9U, .source_port = port, .destination_ip = 0xFFFFFFFFU, .destination_port = port};
}

Result<void> write_capture(const fs::path& file, const SimulatedBerth& berth,
                           const ProgressCallback& progress) {
  auto writer = PcapWriter::create(file);
  if (!writer) return writer.error();
  const LidarConfig lidar = berth.lidar_config();
  const std::vector<std::uint8_t> about_itself = berth.information().datagram;
  InformationTimes telling;
  constexpr std::uint64_t kBatch = 1024;
  std::vector<SimulatedBerth::Packet> batch;
  for (std::uint64_t first = 0; first < berth.packets(); first += kBatch) {
    batch.resize(std::min(kBatch, berth.packets() - first));
    for_each_index(batch.size(), [&](std::size_t i) { batch[i] = berth.packet(first + i); });
    for (std::size_t i = 0; i < batch.size(); ++i) {
      const MeasurementTime time = SimulatedBerth::kEpoch + berth.sent(first + i);
      if (!about_itself.empty() && telling.due(berth.sent(first + i)))
        if (auto done = writer->write(time, broadcast_to(lidar.information_port), about_itself); !done)
          return done;
      if (auto done = writer->write(time, broadcast_to(lidar.port), batch[i]); !done) return done;
    }
    const double share = static_cast<double>(first + batch.size()) / static_cast<double>(berth.packets());
    if (!progress(share)) return Error{"interrupted; nothing was left in the folder"};
  }
  return writer->close();
}

Result<void> write_calibration(PendingFiles& files, const SimulatedBerth& berth) {
  const sim::SensorInformation information = berth.information();
  if (information.calibration_name.empty()) return {};
  return write_text(files.add(information.calibration_name), information.calibration);
}

}  // namespace

std::vector<PlcCsvRow> recorded_plc(const SimulatedBerth& berth) {
  constexpr double kRequestJitter = 0.001;  // s, when the poll goes out
  constexpr double kStampJitter = 0.0005;   // s, the middle of a request against the PLC's own moment
  std::vector<PlcCsvRow> rows;
  const Nanoseconds end = berth.frames() * SimulatedBerth::kFramePeriod + kMargin;
  std::uint64_t poll = 0;
  for (Nanoseconds nominal = -kMargin; nominal <= end; nominal += kPollPeriod, ++poll) {
    RandomStream random(berth.options().seed, 700, poll);
    const auto jitter = [&](double s) { return Nanoseconds{std::llround(random.uniform(-s, s) * 1e9)}; };
    const Nanoseconds answered = nominal + jitter(kRequestJitter);
    const PlcPresented presented = berth.plc(answered);
    rows.push_back({utc_ns(answered + jitter(kStampJitter)), presented.joints.d_x,
                    degrees(presented.joints.theta_r), degrees(presented.joints.theta_p), presented.heartbeat,
                    0});
  }
  return rows;
}

std::vector<TruthRow> recorded_truth(const SimulatedBerth& berth) {
  std::vector<TruthRow> rows;
  const Nanoseconds end = berth.frames() * SimulatedBerth::kFramePeriod + kMargin;
  for (Nanoseconds time = -kMargin; time <= end; time += kTruthPeriod) {
    const HullPose pose = berth.truth(time);
    rows.push_back({utc_ns(time), pose.displacement, in_degrees(pose.rpy), berth.bend(time)});
  }
  return rows;
}

Result<void> write_recording(const SimulatedBerth& berth, const fs::path& folder, bool overwrite,
                             const ProgressCallback& progress) {
  if (auto ready = prepare_folder(folder, overwrite); !ready) return ready;
  PendingFiles files(folder);
  if (auto done = write_text(files.add("hulltrackd.toml"), site_config(berth, {})); !done) return done;
  if (auto done = write_calibration(files, berth); !done) return done;
  if (auto done = write_table(files.add("truth.csv"), recorded_truth(berth)); !done) return done;
  if (auto done = write_table(files.add("plc.csv"), recorded_plc(berth)); !done) return done;
  if (auto done = write_pcd(files.add("hull.pcd"), berth.map()); !done) return done;
  if (!progress(0.0)) return Error{"interrupted; nothing was left in the folder"};
  if (auto done = write_capture(files.add("lidar.pcap"), berth, progress); !done) return done;
  return files.commit();
}

Result<void> write_site_files(const SimulatedBerth& berth, const fs::path& folder, bool overwrite,
                              const std::string& config_text) {
  if (auto ready = prepare_folder(folder, overwrite); !ready) return ready;
  PendingFiles files(folder);
  if (auto done = write_text(files.add("hulltrackd.toml"), config_text); !done) return done;
  if (auto done = write_calibration(files, berth); !done) return done;
  if (auto done = write_pcd(files.add("hull.pcd"), berth.map()); !done) return done;
  return files.commit();
}

}  // namespace hulltrack
