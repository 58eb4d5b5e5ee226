#include "lidar_drivers/robosense/robosense_format.hpp"

#include <algorithm>

namespace hulltrack::robosense {

namespace {

using Pulses = std::array<Nanoseconds, kSlots>;

/// `lasers` pulses, one every `step`.
constexpr Pulses even_pulses(std::size_t lasers, Nanoseconds step) {
  Pulses pulses{};
  for (std::size_t k = 0; k < lasers; ++k) pulses[k] = static_cast<int>(k) * step;
  return pulses;
}

constexpr Pulses helios16p_pulses() {
  constexpr std::array<int, 16> kNs = {0,     3150,  6300,  9450,  13260, 17080, 20560, 23710,
                                       26530, 27770, 31490, 32730, 36460, 38940, 41420, 43910};
  Pulses pulses{};
  for (std::size_t k = 0; k < kNs.size(); ++k) pulses[k] = Nanoseconds(kNs[k]);
  return pulses;
}

/// Two rows of 16, the second 1.44 us behind; the last of each row waits 1.44 us longer.
constexpr Pulses rs32_pulses() {
  Pulses pulses{};
  for (std::size_t k = 0; k < kSlots; ++k) {
    pulses[k] = static_cast<int>(k % 16) * Nanoseconds(2880) + static_cast<int>(k / 16) * Nanoseconds(1440);
  }
  pulses[15] += Nanoseconds(1440);
  pulses[31] = Nanoseconds(46080);
  return pulses;
}

/// Four rows of 8: the third 1.28 us behind the first, the fourth behind the second.
constexpr Pulses bpearl_pulses() {
  Pulses pulses{};
  for (std::size_t k = 0; k < kSlots; ++k) {
    const Nanoseconds row = (k / 8 % 2 == 1 ? Nanoseconds(25680) : Nanoseconds(0)) +
                            (k / 16 == 1 ? Nanoseconds(1280) : Nanoseconds(0));
    pulses[k] = row + static_cast<int>(k % 8) * Nanoseconds(2560);
  }
  return pulses;
}

constexpr std::array<ModelTable, 5> kModels = {{
    {"robosense_rs16", "RS-LiDAR-16", Family::classic, false, "GPS", 16, false, 0.005, 230.0, 0.03825, 0.0,
     Nanoseconds(55500), even_pulses(16, Nanoseconds(2800))},
    {"robosense_rs32", "RS-LiDAR-32", Family::classic, false, "GPS", 32, false, 0.005, 230.0, 0.03997, 0.0,
     Nanoseconds(55520), rs32_pulses()},
    {"robosense_helios32", "RS-Helios-32", Family::helios, true, "PTP, GPS", 32, false, 0.0025, 180.0,
     0.03498, 0.0, Nanoseconds(55560), even_pulses(32, Nanoseconds(1730))},
    {"robosense_helios16p", "RS-Helios-16P", Family::helios, true, "PTP, GPS", 16, false, 0.0025, 180.0,
     0.03498, 0.0, Nanoseconds(55560), helios16p_pulses()},
    {"robosense_bpearl", "RS-Bpearl", Family::classic, true, "PTP, GPS", 32, true, 0.005, 150.0, 0.01473,
     0.09427, Nanoseconds(55520), bpearl_pulses()},
}};

}  // namespace

std::span<const ModelTable> models() { return kModels; }

const ModelTable* find_model(std::string_view name) {
  const auto* it = std::ranges::find(kModels, name, &ModelTable::name);
  return it == kModels.end() ? nullptr : it;
}

}  // namespace hulltrack::robosense
