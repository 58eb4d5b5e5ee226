#include "lidar_drivers/recognition.hpp"

#include <algorithm>

namespace hulltrack {

namespace {

constexpr std::size_t kMostSizes = 16;
constexpr std::size_t kMostPorts = 32;

}  // namespace

Recognition::Recognition() {
  for (const LidarModel& model : lidar_models()) {
    if (model.calibration == LidarModel::Calibration::required) {
      if (model.looks_like) shapes_.push_back({&model});
      continue;
    }
    LidarConfig config;
    config.model = model.name;
    config.time_source = TimeSource::sensor;  // so that its clock is judged
    if (auto builder = ScanBuilder::create({config}, {})) {
      trials_.push_back({&model, std::move(builder).value()});
    }
  }
}

void Recognition::add(const Datagram& datagram) {
  const auto known = ports_.find(datagram.destination_port);
  if (known == ports_.end() && ports_.size() >= kMostPorts) return;
  Traffic& traffic = ports_[datagram.destination_port];
  traffic.port = datagram.destination_port;
  ++traffic.datagrams;
  if (traffic.sizes.size() < kMostSizes || traffic.sizes.contains(datagram.bytes.size())) {
    ++traffic.sizes[datagram.bytes.size()];
  }
  for (Trial& trial : trials_) {
    trial.taken += trial.builder.add(0, datagram).refused() ? 0 : 1;
    while (trial.builder.take(scan_)) {
    }
  }
  for (Shape& shape : shapes_) shape.taken += shape.model->looks_like(datagram.bytes) ? 1 : 0;
}

std::vector<Recognition::Candidate> Recognition::candidates() const {
  std::uint64_t most = 0;
  for (const Trial& trial : trials_) most = std::max(most, trial.taken);
  for (const Shape& shape : shapes_) most = std::max(most, shape.taken);
  std::vector<Candidate> found;
  if (most == 0 || 2 * most < traffic().front().datagrams) return found;
  for (const Trial& trial : trials_) {
    if (trial.taken == most) found.push_back({trial.model, trial.taken, false, trial.builder.status(0)});
  }
  for (const Shape& shape : shapes_) {
    if (shape.taken == most && found.empty()) found.push_back({shape.model, shape.taken, true, {}});
  }
  return found;
}

std::vector<Recognition::Traffic> Recognition::traffic() const {
  std::vector<Traffic> all;
  for (const auto& [port, traffic] : ports_) all.push_back(traffic);
  std::ranges::stable_sort(all, std::ranges::greater{}, &Traffic::datagrams);
  return all;
}

}  // namespace hulltrack
