#include "lidar_drivers/velodyne/velodyne_format.hpp"

#include <algorithm>

namespace hulltrack::velodyne {

namespace {

constexpr std::array<double, 16> kVlp16Elevation = {-15, 1, -13, 3,  -11, 5,  -9, 7,
                                                    -7,  9, -5,  11, -3,  13, -1, 15};
constexpr std::array<double, 16> kVlp16VerticalOffsetMm = {11.2, -0.7, 9.7, -2.2, 8.1, -3.7, 6.6, -5.1,
                                                           5.1,  -6.6, 3.7, -8.1, 2.2, -9.7, 0.7, -11.2};

constexpr std::array<double, 16> kHiResElevation = {
    -10, 0.667, -8.667, 2, -7.333, 3.333, -6, 4.667, -4.667, 6, -3.333, 7.333, -2, 8.667, -0.667, 10};

constexpr std::array<double, 32> kHdl32eElevation = {
    -30.67, -9.33,  -29.33, -8,     -28,    -6.67, -26.67, -5.33,  -25.33, -4,     -24,
    -2.67,  -22.67, -1.33,  -21.33, 0,      -20,   1.33,   -18.67, 2.67,   -17.33, 4,
    -16,    5.33,   -14.67, 6.67,   -13.33, 8,     -12,    9.33,   -10.67, 10.67};

constexpr std::array<double, 32> kVlp32cElevation = {
    -25,    -1,     -1.667, -15.639, -11.31, 0,      -0.667, -8.843, -7.254, 0.333,  -0.333,
    -6.148, -5.333, 1.333,  0.667,   -4,     -4.667, 1.667,  1,      -3.667, -3.333, 3.333,
    2.333,  -2.667, -3,     7,       4.667,  -2.333, -2,     15,     10.333, -1.333};
constexpr std::array<double, 32> kVlp32cAzimuthOffset = {
    1.4, -4.2, 1.4, -1.4, 1.4, -1.4, 4.2, -1.4, 1.4, -4.2, 1.4, -1.4, 4.2, -1.4, 4.2, -1.4,
    1.4, -4.2, 1.4, -4.2, 4.2, -1.4, 1.4, -1.4, 1.4, -1.4, 1.4, -4.2, 4.2, -1.4, 1.4, -1.4};

constexpr Nanoseconds kPuckSequence{55'296};  // 16 pulses and the recharge after them
constexpr Nanoseconds kPuckPulse{2'304};
constexpr Nanoseconds kHdl32eCycle{46'080};
constexpr Nanoseconds kHdl32ePulse{1'152};

/// Sixteen lasers: a block holds two firing sequences.
constexpr std::array<Slot, kSlots> puck_slots(const std::array<double, 16>& elevation,
                                              const std::array<double, 16>& vertical_offset_mm) {
  std::array<Slot, kSlots> slots{};
  for (std::size_t k = 0; k < kSlots; ++k) {
    const std::size_t laser = k % 16;
    slots[k] = {static_cast<std::uint8_t>(laser), elevation[laser], 0.0, vertical_offset_mm[laser] * 1e-3,
                static_cast<int>(k / 16) * kPuckSequence + static_cast<int>(laser) * kPuckPulse};
  }
  return slots;
}

/// Thirty-two lasers, `together` of them at once every `pulse`.
constexpr std::array<Slot, kSlots> row_slots(const std::array<double, 32>& elevation,
                                             const std::array<double, 32>& azimuth_offset,
                                             std::size_t together, Nanoseconds pulse) {
  std::array<Slot, kSlots> slots{};
  for (std::size_t k = 0; k < kSlots; ++k) {
    slots[k] = {static_cast<std::uint8_t>(k), elevation[k], azimuth_offset[k], 0.0,
                static_cast<int>(k / together) * pulse};
  }
  return slots;
}

constexpr std::array<ModelTable, 4> kModels = {{
    {"velodyne_vlp16", "VLP-16", 0x22, 0.002, 2 * kPuckSequence, 100.0, 16,
     puck_slots(kVlp16Elevation, kVlp16VerticalOffsetMm)},
    {"velodyne_puck_hires", "Puck Hi-Res", 0x24, 0.002, 2 * kPuckSequence, 100.0, 16,
     puck_slots(kHiResElevation, {})},
    {"velodyne_hdl32e", "HDL-32E", 0x21, 0.002, kHdl32eCycle, 100.0, 32,
     row_slots(kHdl32eElevation, {}, 1, kHdl32ePulse)},
    {"velodyne_vlp32c", "VLP-32C", 0x28, 0.004, kPuckSequence, 200.0, 32,
     row_slots(kVlp32cElevation, kVlp32cAzimuthOffset, 2, kPuckPulse)},
}};

}  // namespace

std::span<const ModelTable> models() { return kModels; }

const ModelTable* find_model(std::string_view name) {
  const auto* it = std::ranges::find(kModels, name, &ModelTable::name);
  return it == kModels.end() ? nullptr : it;
}

}  // namespace hulltrack::velodyne
