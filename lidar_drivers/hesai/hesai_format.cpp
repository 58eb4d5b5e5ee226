#include "lidar_drivers/hesai/hesai_format.hpp"

#include <algorithm>

namespace hulltrack::hesai {

namespace {

constexpr std::array<double, 40> kPandar40pElevation = {
    15,    11,    8,     5,  3,     2,     1.67, 1.33,  1,     0.67, 0.33,  0,     -0.33, -0.67,
    -1,    -1.33, -1.66, -2, -2.33, -2.67, -3,   -3.33, -3.67, -4,   -4.33, -4.67, -5,    -5.33,
    -5.67, -6,    -7,    -8, -9,    -10,   -11,  -12,   -13,   -14,  -19,   -25};
constexpr std::array<double, 40> kPandar40pAzimuth = {
    -1.042, -1.042, -1.042, -1.042, -1.042, -1.042, 3.125,  -5.208, -1.042, 3.125,
    -5.208, -1.042, 3.125,  -5.208, -1.042, 3.125,  -5.208, -1.042, 3.125,  -5.208,
    -1.042, 3.125,  -5.208, -1.042, 3.125,  -5.208, -1.042, 3.125,  -5.208, -1.042,
    -1.042, -1.042, -1.042, -1.042, -1.042, -1.042, -1.042, -1.042, -1.042, -1.042};
/// ns before the block's end, which its azimuth belongs to.
constexpr std::array<int, 40> kPandar40pLead = {
    42220, 28470, 16040, 3620,  45490, 31740, 47460, 54670, 20620, 33710, 40910, 8190,  20620, 27160,
    50730, 8190,  14740, 36980, 45490, 52700, 23890, 31740, 38950, 11470, 18650, 25190, 48760, 6230,
    12770, 35010, 21920, 9500,  43520, 29770, 17350, 4920,  42220, 28470, 16040, 3620};

constexpr std::array<double, 64> kPandar64Elevation = {
    14.882, 11.032, 8.059,  5.057,   3.04,    2.028,   1.86,   1.688,   1.522,  1.351,  1.184,
    1.013,  0.846,  0.675,  0.508,   0.337,   0.169,   0,      -0.169,  -0.337, -0.508, -0.675,
    -0.845, -1.013, -1.184, -1.351,  -1.522,  -1.688,  -1.86,  -2.028,  -2.198, -2.365, -2.536,
    -2.7,   -2.873, -3.04,  -3.21,   -3.375,  -3.548,  -3.712, -3.884,  -4.05,  -4.221, -4.385,
    -4.558, -4.72,  -4.892, -5.057,  -5.229,  -5.391,  -5.565, -5.726,  -5.898, -6.061, -7.063,
    -8.059, -9.06,  -9.885, -11.032, -12.006, -12.974, -13.93, -18.889, -24.897};
constexpr std::array<double, 64> kPandar64Azimuth = {
    -1.042, -1.042, -1.042, -1.042, -1.042, -1.042, 1.042,  3.125,  5.208,  -5.208, -3.125, -1.042, 1.042,
    3.125,  5.208,  -5.208, -3.125, -1.042, 1.042,  3.125,  5.208,  -5.208, -3.125, -1.042, 1.042,  3.125,
    5.208,  -5.208, -3.125, -1.042, 1.042,  3.125,  5.208,  -5.208, -3.125, -1.042, 1.042,  3.125,  5.208,
    -5.208, -3.125, -1.042, 1.042,  3.125,  5.208,  -5.208, -3.125, -1.042, 1.042,  3.125,  5.208,  -5.208,
    -3.125, -1.042, -1.042, -1.042, -1.042, -1.042, -1.042, -1.042, -1.042, -1.042, -1.042, -1.042};
/// As kPandar40pLead.
constexpr std::array<int, 64> kPandar64Lead = {
    23180, 21876, 20572, 19268, 17964, 16660, 11444, 46796, 7532,  36956, 50732, 54668, 40892,
    44828, 31052, 34988, 48764, 52700, 38924, 42860, 29084, 33020, 46796, 25148, 36956, 50732,
    27116, 40892, 44828, 31052, 34988, 48764, 25148, 38924, 42860, 29084, 33020, 52700, 6228,
    54668, 15356, 27116, 10140, 23180, 4924,  21876, 14052, 17964, 8836,  19268, 3620,  20572,
    12748, 16660, 7532,  11444, 6228,  15356, 10140, 4924,  3620,  14052, 8836,  12748};

constexpr std::array<double, 64> kQt64Elevation = {
    -52.121, -49.785, -47.577, -45.477, -43.465, -41.528, -39.653, -37.831, -36.055, -34.32,  -32.619,
    -30.95,  -29.308, -27.69,  -26.094, -24.517, -22.964, -21.42,  -19.889, -18.372, -16.865, -15.368,
    -13.88,  -12.399, -10.925, -9.457,  -7.994,  -6.535,  -5.079,  -3.626,  -2.175,  -0.725,  0.725,
    2.175,   3.626,   5.079,   6.534,   7.993,   9.456,   10.923,  12.397,  13.877,  15.365,  16.861,
    18.368,  19.885,  21.415,  22.959,  24.524,  26.101,  27.697,  29.315,  30.957,  32.627,  34.328,
    36.064,  37.84,   39.662,  41.537,  43.475,  45.487,  47.587,  49.795,  52.133};
constexpr std::array<double, 64> kQt64Azimuth = {
    8.736,  8.314, 7.964,  7.669,  7.417,  7.198,  7.007,  6.838,  6.688,  6.554,  6.434,  6.326,  6.228,
    6.14,   6.059, 5.987,  -5.27,  -5.216, -5.167, -5.123, -5.083, -5.047, -5.016, -4.988, -4.963, -4.942,
    -4.924, -4.91, -4.898, -4.889, -4.884, -4.881, 5.493,  5.496,  5.502,  5.512,  5.525,  5.541,  5.561,
    5.584,  5.611, 5.642,  5.676,  5.716,  5.759,  5.808,  5.862,  5.921,  -5.33,  -5.396, -5.469, -5.55,
    -5.64,  -5.74, -5.85,  -5.974, -6.113, -6.269, -6.447, -6.651, -6.887, -7.163, -7.493, -7.892};
/// ns after the block's begin.
constexpr std::array<int, 64> kQt64Delay = {
    2310,   4370,   6430,   8490,   10540,  12600,  14660,  16710,  19160,  21220,  23280,  25340,  27390,
    29450,  31500,  33560,  36610,  38670,  40730,  42780,  44840,  46900,  48950,  51010,  53450,  55520,
    57580,  59630,  61690,  63740,  65800,  67860,  70900,  72970,  75020,  77080,  79140,  81190,  83250,
    85300,  87750,  89820,  91870,  93930,  95980,  98040,  100100, 102150, 105200, 107260, 109320, 111380,
    113430, 115490, 117540, 119600, 122050, 124110, 126170, 128220, 130280, 132340, 134390, 136450};

/// Lasers from `top` down, `step` degrees apart, all in one upright plane.
template <std::size_t lasers>
constexpr std::array<LaserAngles, kMaxLasers> fan(double top, double step) {
  std::array<LaserAngles, kMaxLasers> angles{};
  for (std::size_t k = 0; k < lasers; ++k) angles[k] = {top - step * static_cast<double>(k), 0.0};
  return angles;
}

template <std::size_t lasers>
constexpr std::array<LaserAngles, kMaxLasers> table(const std::array<double, lasers>& elevation,
                                                    const std::array<double, lasers>& azimuth) {
  std::array<LaserAngles, kMaxLasers> angles{};
  for (std::size_t k = 0; k < lasers; ++k) angles[k] = {elevation[k], azimuth[k]};
  return angles;
}

/// One pulse every `pulse`, of `lasers` lasers; further ones fire together with those again.
template <std::size_t lasers>
constexpr std::array<Nanoseconds, kMaxLasers> row(Nanoseconds pulse) {
  std::array<Nanoseconds, kMaxLasers> firing{};
  for (std::size_t k = 0; k < kMaxLasers; ++k)
    firing[k] = Nanoseconds(368) + static_cast<int>(k % lasers) * pulse;
  return firing;
}

template <std::size_t lasers>
constexpr std::array<Nanoseconds, kMaxLasers> times(const std::array<int, lasers>& ns, int sign) {
  std::array<Nanoseconds, kMaxLasers> firing{};
  for (std::size_t k = 0; k < lasers; ++k) firing[k] = Nanoseconds(sign * ns[k]);
  return firing;
}

constexpr HeaderLayout kNoHeader{};
constexpr HeaderLayout kShortHeader = {
    .bytes = 8, .protocol = 0, .lasers = 2, .blocks = 3, .distance_unit = 5, .flags = 0};
constexpr HeaderLayout kHeader = {
    .bytes = 12, .protocol = 2, .lasers = 6, .blocks = 7, .distance_unit = 9, .flags = 11};
constexpr TailLayout kPandarTail = {
    .bytes = 22, .return_mode = 14, .motor_speed = 8, .date = 16, .microseconds = 10};
constexpr TailLayout kQtTail = {
    .bytes = 24, .return_mode = 16, .motor_speed = 10, .date = 18, .microseconds = 12};
constexpr TailLayout kXtTail = {
    .bytes = 24, .return_mode = 10, .motor_speed = 11, .date = 13, .microseconds = 19};

constexpr Nanoseconds kXtPeriod{50'000};
constexpr Nanoseconds kXtBlockTime{5'632};
constexpr Nanoseconds kPandarPeriod{55'560};

constexpr std::array<ModelTable, 6> kModels = {{
    {"hesai_xt16", "PandarXT-16", 120.0, 16, 8, 4, 2, 6, 4, kHeader, kXtTail, 1900, kXtPeriod, kXtBlockTime,
     false, fan<16>(15.0, 2.0), row<16>(Nanoseconds(3'024))},
    {"hesai_xt32", "PandarXT-32", 120.0, 32, 8, 4, 2, 6, 4, kHeader, kXtTail, 1900, kXtPeriod, kXtBlockTime,
     false, fan<32>(15.0, 1.0), row<32>(Nanoseconds(1'512))},
    {"hesai_xt32m", "XT32M2X", 300.0, 32, 6, 4, 3, 6, 5, kHeader, kXtTail, 1900, kXtPeriod, kXtBlockTime,
     false, fan<32>(19.5, 1.3), row<16>(Nanoseconds(2'888))},
    {"hesai_pandar40p", "Pandar40P", 200.0, 40, 10, 3, 2, 0, 4, kNoHeader, kPandarTail, 2000, kPandarPeriod,
     Nanoseconds(-28'580), false, table(kPandar40pElevation, kPandar40pAzimuth), times(kPandar40pLead, -1)},
    {"hesai_pandar64", "Pandar64", 200.0, 64, 6, 3, 2, 0, 4, kShortHeader, kPandarTail, 2000, kPandarPeriod,
     Nanoseconds(-42'580), false, table(kPandar64Elevation, kPandar64Azimuth), times(kPandar64Lead, -1)},
    {"hesai_qt64", "PandarQT", 60.0, 64, 4, 4, 2, 3, 4, kHeader, kQtTail, 1900, Nanoseconds(166'667),
     Nanoseconds(25'710), true, table(kQt64Elevation, kQt64Azimuth), times(kQt64Delay, 1)},
}};

}  // namespace

Nanoseconds ModelTable::first_pulse() const {
  return *std::min_element(firing.begin(), firing.begin() + static_cast<std::ptrdiff_t>(lasers));
}

Nanoseconds ModelTable::last_pulse() const {
  return *std::max_element(firing.begin(), firing.begin() + static_cast<std::ptrdiff_t>(lasers));
}

std::size_t returns_of_mode(std::uint8_t mode) {
  switch (mode) {
    case kModeFirst:
    case kModeStrongest:
    case kModeLast:
      return 1;
    case kModeLastStrongest:
    case kModeLastFirst:
    case kModeFirstStrongest:
      return 2;
    case kModeTriple:
      return 3;
    default:
      return 0;
  }
}

std::span<const ModelTable> models() { return kModels; }

const ModelTable* find_model(std::string_view name) {
  const auto* it = std::ranges::find(kModels, name, &ModelTable::name);
  return it == kModels.end() ? nullptr : it;
}

}  // namespace hulltrack::hesai
