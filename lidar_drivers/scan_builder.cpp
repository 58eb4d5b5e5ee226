#include "lidar_drivers/scan_builder.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <numbers>
#include <utility>

#include "lidar_drivers/datagram_router.hpp"
#include "lidar_drivers/model_registry.hpp"

namespace hulltrack {

namespace {

constexpr Nanoseconds kRateWindow = std::chrono::seconds(1);
constexpr double kRpmSmoothing = 0.05;  // weight of the newest datagram

}  // namespace

Result<ScanBuilder> ScanBuilder::create(const std::vector<LidarConfig>& lidars,
                                        const FramingConfig& framing) {
  if (lidars.empty()) return Error{"no LiDAR is configured; add a [[lidar]] section"};
  if (!(framing.frame_rate_hz > 0.0 && framing.frame_rate_hz <= 1000.0)) {
    return Error{"frame_rate_hz: " + std::to_string(framing.frame_rate_hz) + " is outside (0, 1000]"};
  }
  std::vector<Lidar> built;
  for (const LidarConfig& config : lidars) {
    const LidarModel* model = find_lidar_model(config.model);
    if (model == nullptr) {
      return Error{"lidar \"" + config.name + "\": unknown model \"" + config.model +
                   "\"; `hulltrack models` lists the known ones"};
    }
    const DecoderOptions options{.firing_correction = config.firing_correction};
    auto decoder = make_lidar_decoder(*model, options, config.calibration);
    if (!decoder) return Error{"lidar \"" + config.name + "\": " + decoder.error().message};
    const Nanoseconds wrap = decoder.value()->clock_wrap();
    Lidar lidar{.config = config,
                .range = model->range,
                .decoder = std::move(decoder).value(),
                .sequence = PacketSequence(wrap),
                .clock = SensorClock(wrap),
                .sender = SenderLock(config.timeout)};
    built.push_back(std::move(lidar));
  }
  return ScanBuilder(std::move(built), framing);
}

ScanBuilder::ScanBuilder(std::vector<Lidar> lidars, const FramingConfig& framing)
    : framing_(framing.framing), lidars_(std::move(lidars)), frames_(framing, lidars_.size()) {}

bool ScanBuilder::takes(std::size_t index, const Datagram& datagram) {
  assert(index < lidars_.size());
  Lidar& lidar = lidars_[index];
  if (!lidar.config.source.empty() || lidar.sender.takes(datagram.source_ip, datagram.received)) {
    return true;
  }
  ++frames_.counters(index).packets_rejected;
  return false;
}

DecodeOutcome ScanBuilder::add(std::size_t index, const Datagram& datagram) {
  assert(index < lidars_.size());
  Lidar& lidar = lidars_[index];
  if (lidar.decoder->inform(datagram.bytes)) {
    ++lidar.status.informations;
    return {};
  }
  const DecodeOutcome outcome = lidar.decoder->decode(datagram.bytes, packet_);
  if (outcome.status == DecodeStatus::awaiting_angles) {
    ++lidar.status.packets_held_back;
    lidar.status.angles_contradicted = outcome.seen == kContradicted;
    return outcome;
  }
  if (!outcome.ok()) {
    ++lidar.status.packets_rejected;
    ++frames_.counters(index).packets_rejected;
    lidar.last_rejection = outcome;
    lidar.rejected_ip = datagram.source_ip;
    lidar.rejected_port = datagram.source_port;
    return outcome;
  }
  lidar.sender.decoded(datagram.source_ip, datagram.received);
  const PacketSequence::Step step = lidar.sequence.note(datagram.bytes, packet_, datagram.received);
  note_sequence(index, step);
  if (step.place == PacketSequence::Place::duplicate) return outcome;
  drop_out_of_range(lidar);

  MeasurementTime last = host_or_sensor_time(lidar, packet_, datagram);
  if (step.place == PacketSequence::Place::out_of_order) {
    last = lidar.newest - step.behind;
  } else {
    if (framing_ == Framing::revolution && index == 0) {
      if (const auto boundary = zero_crossing(lidar, last)) {
        lidar.last_crossing = boundary;
        frames_.cut(*boundary);
      }
    }
    note_packet(lidar, last);
    lidar.status.last_received = datagram.received;
  }
  const FrameAssembler::Refused refused = frames_.place(index, packet_, last);
  lidar.status.points_late += refused.late;
  lidar.status.points_over_limit += refused.over_limit;
  return outcome;
}

/// Every wire format can say distances that its sensor does not measure (a VLP-16's 131 m, an Ouster's 1,049
/// m, a Livox's thousands of kilometres): there stand damaged bytes, or returns of which the maker states no
/// accuracy. Counted from L's origin, some centimetres beside the optical one. NaN is out of range too.
void ScanBuilder::drop_out_of_range(Lidar& lidar) {
  const double most = lidar.range * lidar.range;
  lidar.status.points_out_of_range += std::erase_if(packet_.points, [&](const LidarPoint& point) {
    const double x = point.x;
    const double y = point.y;
    const double z = point.z;
    return !(x * x + y * y + z * z <= most);
  });
}

void ScanBuilder::note_sequence(std::size_t index, const PacketSequence::Step& step) {
  Lidar& lidar = lidars_[index];
  LidarStatus& status = lidar.status;
  LidarFrameCounters& frame = frames_.counters(index);
  ++status.packets;
  switch (step.place) {
    case PacketSequence::Place::first:
    case PacketSequence::Place::next:
      status.packets_lost += step.lost;
      frame.packets_lost += step.lost;
      lidar.window.lost += step.lost;
      break;
    case PacketSequence::Place::duplicate:
      ++status.packets_duplicate;
      break;
    case PacketSequence::Place::out_of_order:  // it had been counted as lost when the next one came
      ++status.packets_out_of_order;
      if (status.packets_lost > 0) --status.packets_lost;
      if (frame.packets_lost > 0) --frame.packets_lost;
      if (lidar.window.lost > 0) --lidar.window.lost;
      break;
    case PacketSequence::Place::restart:
      ++status.clock_restarts;
      break;
  }
}

MeasurementTime ScanBuilder::host_or_sensor_time(Lidar& lidar, const DecodedPacket& packet,
                                                 const Datagram& datagram) {
  const Nanoseconds offset =
      lidar.clock.note(packet.sensor_time, datagram.received_utc, packet.clock_reference);
  if (lidar.config.time_source == TimeSource::receive) return datagram.received;
  lidar.status.clock_fault = !lidar.clock.believed();
  // The clock is judged once a second; set by some milliseconds in between, it must not carry a point
  // farther.
  const bool is_near = std::chrono::abs(offset) <= SensorClock::kTolerance;
  return lidar.status.clock_fault || !is_near ? datagram.received : datagram.received + offset;
}

std::optional<MeasurementTime> ScanBuilder::zero_crossing(const Lidar& lidar, MeasurementTime last) const {
  std::optional<MeasurementTime> crossing;
  if (packet_.zero_crossing) {
    crossing = last + *packet_.zero_crossing;
  } else if (packet_.first_azimuth < lidar.newest_azimuth - std::numbers::pi) {
    crossing = last - packet_.duration;  // it passed zero between the two datagrams
  }
  if (!crossing || packet_.rotation_rate <= 0.0) return std::nullopt;
  // Jitter of the reported azimuth can show the same passage twice; half a turn has to lie between two.
  const double since_last = lidar.last_crossing ? to_seconds(*crossing - *lidar.last_crossing) : 1e9;
  const bool same_passage = since_last >= 0.0 && since_last * packet_.rotation_rate < std::numbers::pi;
  return same_passage ? std::nullopt : crossing;
}

void ScanBuilder::note_packet(Lidar& lidar, MeasurementTime time) {
  LidarStatus& status = lidar.status;
  lidar.newest = time;
  lidar.newest_azimuth = packet_.last_azimuth;
  const bool known = status.return_mode != ReturnMode::unknown;
  if (known && status.return_mode != packet_.return_mode) ++status.return_mode_changes;
  status.return_mode = packet_.return_mode;
  status.field_of_view_cut = status.field_of_view_cut || packet_.cut_azimuth.has_value();
  const double rpm = packet_.rotation_rate * 30.0 / std::numbers::pi;
  status.rpm = known ? status.rpm + kRpmSmoothing * (rpm - status.rpm) : rpm;

  const Nanoseconds elapsed = time - lidar.window.begin;
  if (elapsed < Nanoseconds::zero() || elapsed >= 2 * kRateWindow) {
    lidar.window = {time, 0, 0};
  } else if (elapsed >= kRateWindow) {
    const auto packets = static_cast<double>(lidar.window.packets);
    const auto lost = static_cast<double>(lidar.window.lost);
    status.packets_per_second = packets / to_seconds(elapsed);
    status.loss = packets + lost > 0.0 ? lost / (packets + lost) : 0.0;
    lidar.window = {time, 0, 0};
  }
  ++lidar.window.packets;
}

void ScanBuilder::advance(MeasurementTime now) { frames_.advance(now); }

void ScanBuilder::finish() { frames_.finish(); }

bool ScanBuilder::take(Scan& out) { return frames_.take(out); }

LidarStatus ScanBuilder::status(std::size_t index) const {
  assert(index < lidars_.size());
  const Lidar& lidar = lidars_[index];
  LidarStatus status = lidar.status;
  status.clock = lidar.clock.reading();
  status.packets_of_another = lidar.sender.dropped();
  status.disputed = lidar.config.source.empty() && lidar.sender.disputed();
  return status;
}

std::string ScanBuilder::two_senders(std::size_t index) const {
  assert(index < lidars_.size());
  const Lidar& lidar = lidars_[index];
  if (lidar.sender.dropped() == 0) return {};
  return "two sensors send to UDP port " + std::to_string(lidar.config.port) + ": " +
         format_ipv4(lidar.sender.first()) + " and " + format_ipv4(lidar.sender.second());
}

std::string ScanBuilder::last_rejection(std::size_t index) const {
  assert(index < lidars_.size());
  const Lidar& lidar = lidars_[index];
  if (lidar.status.packets_rejected == 0) return {};
  return lidar.decoder->explain(lidar.last_rejection) + " from " + format_ipv4(lidar.rejected_ip) + ":" +
         std::to_string(lidar.rejected_port);
}

}  // namespace hulltrack
