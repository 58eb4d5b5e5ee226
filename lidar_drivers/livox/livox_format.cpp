#include "lidar_drivers/livox/livox_format.hpp"

#include <algorithm>

namespace hulltrack::livox {

namespace {

constexpr RecordKind kKinds1[] = {
    {.type = 0, .bytes = 13, .echoes = 1, .echo_bytes = 13, .tagged = false, .records = 100},
    {.type = 1, .bytes = 9, .echoes = 1, .echo_bytes = 9, .spherical = true, .tagged = false, .records = 100},
    {.type = 2, .bytes = 14, .echoes = 1, .echo_bytes = 14, .records = 96},
    {.type = 3, .bytes = 10, .echoes = 1, .echo_bytes = 10, .spherical = true, .records = 96},
    {.type = 4, .bytes = 28, .echoes = 2, .echo_bytes = 14, .records = 48},
    {.type = 5, .bytes = 16, .echoes = 2, .echo_bytes = 6, .spherical = true, .records = 48},
    {.type = 7, .bytes = 42, .echoes = 3, .echo_bytes = 14, .records = 30},
    {.type = 8, .bytes = 22, .echoes = 3, .echo_bytes = 6, .spherical = true, .records = 30},
};

constexpr RecordKind kKinds2[] = {
    {.type = 1, .bytes = 14, .echoes = 1, .echo_bytes = 14},
    {.type = 2, .bytes = 8, .echoes = 1, .echo_bytes = 8, .narrow = true},
    {.type = 3, .bytes = 10, .echoes = 1, .echo_bytes = 10, .spherical = true},
    {.type = 0x11, .bytes = 28, .echoes = 2, .echo_bytes = 14},
};

constexpr ClockReference kStampTypes1[] = {ClockReference::none, ClockReference::ptp, ClockReference::unknown,
                                           ClockReference::gps, ClockReference::pulse};
constexpr ClockReference kStampTypes2[] = {ClockReference::none, ClockReference::ptp, ClockReference::gps};

}  // namespace

constexpr Generation kGeneration1{.version = 5,
                                  .header = 18,
                                  .type_offset = 9,
                                  .stamp_type_offset = 8,
                                  .stamp_types = kStampTypes1,
                                  .stamp_offset = 10,
                                  .imu_type = 6,
                                  .kinds = kKinds1};
constexpr Generation kGeneration2{.version = 0,
                                  .header = 36,
                                  .type_offset = 10,
                                  .stamp_type_offset = 11,
                                  .stamp_types = kStampTypes2,
                                  .stamp_offset = 28,
                                  .imu_type = 0,
                                  .kinds = kKinds2};

std::span<const ModelTable> models() {
  // 200,000, 452,000 and 240,000 shots a second. An Avia's host picks the port when it sets the sensor up, so
  // its figure is no more than a proposal.
  static constexpr ModelTable kModels[] = {
      {"livox_mid360", "Mid-360", "PTP, GPS", &kGeneration2, 56301, 70.0, 4, Nanoseconds(5000), false},
      {"livox_hap", "HAP", "PTP", &kGeneration2, 57000, 150.0, 6, Nanoseconds(2212), true},
      {"livox_avia", "Avia", "PTP, GPS", &kGeneration1, 56001, 320.0, 6, Nanoseconds(4167), true},
  };
  return kModels;
}

const ModelTable* find_model(std::string_view name) {
  const auto all = models();
  const auto it = std::ranges::find(all, name, &ModelTable::name);
  return it == all.end() ? nullptr : &*it;
}

}  // namespace hulltrack::livox
