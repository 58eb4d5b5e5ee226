#include "daemon/simulator/run/departures.hpp"

namespace hulltrack {
namespace {

constexpr Nanoseconds kInformationPeriod = std::chrono::seconds(1);

}  // namespace

Departures::Departures(const SimulatedBerth& berth, Nanoseconds from) : berth_(&berth) {
  for (std::size_t i = 0; i < berth.lidars().size(); ++i) {
    const SimulatedLidar& sensor = berth.lidars()[i];
    Lidar lidar{.informs = !sensor.information().datagram.empty()};
    while (lidar.packet < sensor.packets() && sensor.encoder().first_firing(lidar.packet) < from)
      ++lidar.packet;
    lidars_.push_back(lidar);
    skip_unplugged(i);
  }
}

void Departures::skip_unplugged(std::size_t lidar) {
  const SimulatedLidar& sensor = berth_->lidars()[lidar];
  std::uint64_t& packet = lidars_[lidar].packet;
  while (packet < sensor.packets() && !berth_->plugged_in(lidar, sensor.sent(packet))) ++packet;
}

std::optional<Departure> Departures::next() {
  std::optional<Departure> first;
  for (std::size_t i = 0; i < lidars_.size(); ++i) {
    const SimulatedLidar& sensor = berth_->lidars()[i];
    const std::uint64_t packet = lidars_[i].packet;
    if (packet >= sensor.packets() || (first && first->time <= sensor.sent(packet))) continue;
    first = Departure{i, sensor.sent(packet), packet};
  }
  if (!first) return first;
  Lidar& lidar = lidars_[first->lidar];
  if (lidar.informs && first->time >= lidar.information_due) {
    lidar.information_due = first->time + kInformationPeriod;
    first->packet.reset();
    return first;
  }
  ++lidar.packet;
  skip_unplugged(first->lidar);
  return first;
}

std::vector<Departure> Departures::next(std::size_t count) {
  std::vector<Departure> departures;
  while (departures.size() < count) {
    const auto departure = next();
    if (!departure) break;
    departures.push_back(*departure);
  }
  return departures;
}

SimulatedBerth::Packet bytes_of(const SimulatedBerth& berth, const Departure& departure) {
  const SimulatedLidar& lidar = berth.lidars()[departure.lidar];
  return departure.packet ? lidar.packet(*departure.packet) : lidar.information().datagram;
}

}  // namespace hulltrack
