// `hulltrack decode`: the points of a capture as the driver decodes them, in L, as CSV or PCD.
//
// Rows are in wire order with both returns of a dual pair; no range limits. A point's time is the capture's
// stamp of its packet (its last firing) minus the time from that firing to the last.
#include <cerrno>
#include <charconv>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <memory>
#include <numbers>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "core/base/text.hpp"
#include "core/io/pcd_writer.hpp"
#include "daemon/config/nearest_name.hpp"
#include "daemon/tools/tools.hpp"
#include "lidar_drivers/datagram_router.hpp"
#include "lidar_drivers/model_registry.hpp"
#include "lidar_drivers/pcap_source.hpp"

namespace hulltrack {
namespace {

struct DecodeOptions {
  std::string capture;
  std::string model;
  std::string calibration;
  std::optional<std::uint16_t> port;
  std::optional<std::uint16_t> information_port;
  std::string source;
  std::filesystem::path out;
  bool no_firing_correction = false;
  bool no_vertical_offset = false;
};

/// Where decoded packets go.
class PointFile {
 public:
  PointFile() = default;
  PointFile(const PointFile&) = delete;
  PointFile& operator=(const PointFile&) = delete;
  virtual ~PointFile() = default;
  virtual void add(std::uint64_t packet, const std::vector<LidarPoint>& points,
                   MeasurementTime last_firing) = 0;
  /// Nothing is sure to be on disk before this; throws ToolError.
  virtual void finish() = 0;
};

class CsvPointFile final : public PointFile {
 public:
  explicit CsvPointFile(const std::filesystem::path& path)
      : path_(path), file_(std::fopen(path.c_str(), "wb")) {
    if (!file_) fail();
    text_ = "packet,channel,t_ns,x,y,z,intensity\n";
  }

  void add(std::uint64_t packet, const std::vector<LidarPoint>& points,
           MeasurementTime last_firing) override {
    for (const LidarPoint& point : points) {
      append(packet, ',');
      append(unsigned{point.channel}, ',');
      append(to_ns(last_firing) + point.dt_ns, ',');
      append(point.x, ',');
      append(point.y, ',');
      append(point.z, ',');
      append(point.intensity, '\n');
    }
    if (text_.size() > kFlushBytes) flush();
  }

  void finish() override {
    flush();
    if (std::fclose(file_.release()) != 0) fail();
  }

 private:
  static constexpr std::size_t kFlushBytes = 1 << 20;
  struct Close {
    void operator()(std::FILE* file) const { std::fclose(file); }
  };

  /// Shortest text that reads back as the same number.
  template <typename T>
  void append(T value, char separator) {
    char digits[32];
    const auto written = std::to_chars(digits, digits + sizeof digits, value);
    text_.append(digits, written.ptr);
    text_.push_back(separator);
  }

  void flush() {
    if (!text_.empty() && std::fwrite(text_.data(), text_.size(), 1, file_.get()) != 1) fail();
    text_.clear();
  }

  [[noreturn]] void fail() const {
    throw ToolError(path_.string() + ": cannot be written: " + std::strerror(errno) +
                    "; free some space or choose another place");
  }

  std::filesystem::path path_;
  std::unique_ptr<std::FILE, Close> file_;
  std::string text_;
};

class PcdPointFile final : public PointFile {
 public:
  explicit PcdPointFile(std::filesystem::path path) : path_(std::move(path)) {}

  void add(std::uint64_t, const std::vector<LidarPoint>& points, MeasurementTime) override {
    for (const LidarPoint& point : points) {
      cloud_.emplace_back(point.x, point.y, point.z);
      intensity_.push_back(point.intensity);
    }
  }

  void finish() override {
    if (auto written = write_pcd(path_, cloud_, intensity_); !written)
      throw ToolError(written.error().message);
  }

 private:
  std::filesystem::path path_;
  Cloud cloud_;
  std::vector<float> intensity_;
};

const LidarModel& model_of(const DecodeOptions& options) {
  if (const LidarModel* model = find_lidar_model(options.model)) return *model;
  std::vector<std::string> names;
  for (const LidarModel& model : lidar_models()) names.emplace_back(model.name);
  const auto near = nearest_name(options.model, names);
  throw ToolError(kExitUsage, "--model: unknown model \"" + options.model + "\"" +
                                  (near ? "; did you mean " + *near + "?" : "") +
                                  " (`hulltrack models` lists them)");
}

/// The file of --out: written under a temporary name beside it, which is gone again without commit().
class PendingOutput {
 public:
  explicit PendingOutput(const DecodeOptions& options)
      : path_(options.out), temporary_(options.out.string() + ".part") {
    const auto kind = path_.extension();
    if (kind != ".csv" && kind != ".pcd")
      throw ToolError(kExitUsage, "--out " + path_.string() + ": the name must end in .csv or .pcd");
    std::error_code differ;  // or one of them does not exist
    for (const std::string& input : {options.capture, options.calibration})
      if (std::filesystem::equivalent(input, path_, differ))
        throw ToolError(kExitUsage,
                        "--out " + path_.string() + ": is what it reads from; choose another name");
    if (kind == ".csv")
      points_ = std::make_unique<CsvPointFile>(temporary_);
    else
      points_ = std::make_unique<PcdPointFile>(temporary_);
  }
  PendingOutput(const PendingOutput&) = delete;
  PendingOutput& operator=(const PendingOutput&) = delete;
  ~PendingOutput() {
    std::error_code ignored;
    std::filesystem::remove(temporary_, ignored);
  }

  PointFile& points() { return *points_; }

  void commit() {
    points_->finish();
    std::error_code failure;
    std::filesystem::rename(temporary_, path_, failure);
    if (failure) throw ToolError(path_.string() + ": cannot be put in place: " + failure.message());
  }

 private:
  std::filesystem::path path_, temporary_;
  std::unique_ptr<PointFile> points_;
};

/// What the capture held, for the summary and for telling why nothing was found.
struct DecodeTally {
  std::uint64_t packets = 0;  // data datagrams: of the model's size
  std::uint64_t decoded = 0;
  std::uint64_t rejected = 0;
  std::uint64_t points = 0;
  DecodeOutcome last_rejection;
  ReturnMode return_mode = ReturnMode::unknown;
  double rpm = 0.0;
  std::optional<MeasurementTime> first;
  MeasurementTime last{};
  std::set<std::uint32_t> senders;
};

void decode_datagram(Decoder& decoder, const Datagram& datagram, DecodedPacket& packet, PointFile& out,
                     DecodeTally& tally) {
  if (decoder.inform(datagram.bytes)) return;
  const DecodeOutcome outcome = decoder.decode(datagram.bytes, packet);
  const std::uint64_t index = tally.packets;
  if (outcome.status != DecodeStatus::wrong_size) ++tally.packets;
  if (!outcome.ok()) {
    ++tally.rejected;
    tally.last_rejection = outcome;
    return;
  }
  ++tally.decoded;
  tally.points += packet.points.size();
  tally.return_mode = packet.return_mode;
  tally.rpm = packet.rotation_rate * 30.0 / std::numbers::pi;
  if (!tally.first) tally.first = datagram.received - packet.duration;
  tally.last = datagram.received;
  tally.senders.insert(datagram.source_ip);
  out.add(index, packet.points, datagram.received);
}

/// Takes in what the sensor tells about itself anywhere in the capture, so that the data before it can be
/// decoded too.
void learn_from_capture(const DecodeOptions& options, const LidarModel& model, PcapFilter filter,
                        Decoder& decoder) {
  filter.port = options.information_port.value_or(model.information_port);
  auto capture = PcapSource::open(options.capture, filter);
  if (!capture) throw ToolError(capture.error().message);
  Datagram datagram;
  for (auto more = capture->next(datagram); more && *more; more = capture->next(datagram))
    if (decoder.inform(datagram.bytes)) return;
}

std::string join_addresses(const std::set<std::uint32_t>& ips) {
  std::string text;
  for (const std::uint32_t ip : ips) text += (text.empty() ? "" : ", ") + format_ipv4(ip);
  return text;
}

void print_summary(const DecodeOptions& options, const Decoder& decoder, const DecodeTally& tally) {
  std::fprintf(stderr, "%s: %s, %s, %s return, %.0f rpm, %.3f s\n", options.out.c_str(),
               counted(tally.decoded, "packet").c_str(), counted(tally.points, "point").c_str(),
               return_mode_name(tally.return_mode), tally.rpm, to_seconds(tally.last - *tally.first));
  if (tally.rejected > 0) {
    std::fprintf(stderr, "%s refused, the last because: %s\n", counted(tally.rejected, "datagram").c_str(),
                 decoder.explain(tally.last_rejection).c_str());
  }
  if (tally.senders.size() > 1) {
    std::fprintf(stderr, "several LiDARs are mixed in it (%s); --source picks one\n",
                 join_addresses(tally.senders).c_str());
  }
}

void decode(const DecodeOptions& options) {
  const LidarModel& model = model_of(options);
  PcapFilter filter;
  filter.port = options.port.value_or(model.port);
  if (!options.source.empty()) {
    const auto source = parse_ipv4(options.source);
    if (!source) throw ToolError(kExitUsage, "--source: " + source.error().message);
    filter.source_ip = *source;
  }
  const DecoderOptions decoder_options{.firing_correction = !options.no_firing_correction,
                                       .vertical_offset = !options.no_vertical_offset,
                                       .repeated_echoes = true};
  const auto decoder = make_lidar_decoder(model, decoder_options, options.calibration);
  if (!decoder) throw ToolError("--calibration: " + decoder.error().message);
  if (model.information_port != 0 && options.calibration.empty())
    learn_from_capture(options, model, filter, **decoder);
  auto capture = PcapSource::open(options.capture, filter);
  if (!capture) throw ToolError(capture.error().message);

  PendingOutput out(options);
  DecodeTally tally;
  DecodedPacket packet;
  Datagram datagram;
  auto more = capture->next(datagram);
  for (; more && *more; more = capture->next(datagram))
    decode_datagram(**decoder, datagram, packet, out.points(), tally);

  if (tally.decoded > 0) {
    out.commit();
    print_summary(options, **decoder, tally);
  }
  if (!more) throw ToolError(more.error().message);
  if (tally.decoded > 0) return;
  if (tally.rejected == 0) throw ToolError(capture->explain_nothing_found());
  throw ToolError(options.capture + ": none of " + std::to_string(tally.rejected) +
                  " datagrams to UDP port " + std::to_string(*filter.port) + " is of a " +
                  std::string(model.name) + ": " + (*decoder)->explain(tally.last_rejection));
}

}  // namespace

void add_decode(CLI::App& app) {
  auto options = std::make_shared<DecodeOptions>();
  CLI::App* command =
      app.add_subcommand("decode", "The points of a capture, in the LiDAR's own frame, as CSV or PCD.");
  command->footer(
      "Example: hulltrack decode lidar.pcap --model velodyne_vlp16 --out points.csv\n"
      "CSV: packet,channel,t_ns,x,y,z,intensity; metres in L, UTC nanoseconds, rows in wire order.");
  command->add_option("PCAP", options->capture, "Capture, pcap or pcapng")->required();
  command->add_option("--model", options->model, "LiDAR model, see `hulltrack models`")->required();
  command->add_option("--calibration", options->calibration, "Calibration file, for models that need one");
  command->add_option("--port", options->port, "UDP port the LiDAR sends to (default: the model's)");
  command->add_option("--information-port", options->information_port,
                      "UDP port on which the LiDAR tells its lasers' angles (default: the model's)");
  command->add_option("--source", options->source, "Only datagrams from this address (default: any)");
  command->add_option("--out", options->out, "File to write, .csv or .pcd")->required();
  command->add_flag("--no-firing-correction", options->no_firing_correction,
                    "One azimuth a block instead of one a laser");
  command->add_flag("--no-vertical-offset", options->no_vertical_offset, "Leave out the lasers' own heights");
  command->callback([options] { decode(*options); });
}

}  // namespace hulltrack
