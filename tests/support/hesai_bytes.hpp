// Hesai datagrams written byte by byte from the manuals, independent of encoder and tables.
#pragma once

#include <cstdint>
#include <string_view>
#include <vector>

namespace hulltrack::test {

using HesaiBytes = std::vector<std::uint8_t>;

/// Where what stands in one model's datagram.
struct HesaiModel {
  std::string_view name;
  std::size_t size;    // with a sequence number
  std::size_t header;  // bytes
  int lasers, blocks, return_bytes;
  std::size_t tail, mode, motor, date, microseconds, sequence;
  int year_base;
};

inline constexpr HesaiModel kHesaiModels[] = {
    {"hesai_xt16", 568, 12, 16, 8, 4, 540, 550, 551, 553, 559, 564, 1900},
    {"hesai_xt32", 1080, 12, 32, 8, 4, 1052, 1062, 1063, 1065, 1071, 1076, 1900},
    {"hesai_xt32m", 820, 12, 32, 6, 4, 792, 802, 803, 805, 811, 816, 1900},
    {"hesai_pandar40p", 1266, 0, 40, 10, 3, 1240, 1254, 1248, 1256, 1250, 1262, 2000},
    {"hesai_pandar64", 1198, 8, 64, 6, 3, 1172, 1186, 1180, 1188, 1182, 1194, 2000},
    {"hesai_qt64", 1072, 12, 64, 4, 4, 1044, 1060, 1054, 1062, 1056, 1068, 1900},
};

inline const HesaiModel& hesai_model(std::string_view name) {
  for (const HesaiModel& model : kHesaiModels) {
    if (model.name == name) return model;
  }
  return kHesaiModels[0];
}

inline void put_le(HesaiBytes& bytes, std::size_t at, std::uint32_t value, std::size_t count) {
  for (std::size_t i = 0; i < count; ++i) bytes[at + i] = static_cast<std::uint8_t>(value >> (8 * i));
}

inline std::size_t hesai_block(const HesaiModel& model, std::size_t block) {
  const auto returns = static_cast<std::size_t>(model.lasers * model.return_bytes);
  return model.header + block * ((model.header == 0 ? 4U : 2U) + returns);
}

/// Azimuths of every block, from `first` on in 0.01 deg, `step` more after each `same` blocks.
inline std::vector<int> hesai_azimuths(const HesaiModel& model, int first, int step, int same = 1) {
  std::vector<int> azimuths;
  for (int b = 0; b < model.blocks; ++b) azimuths.push_back((first + b / same * step) % 36000);
  return azimuths;
}

/// Without returns; 2023-04-05 06:07:08.5, sequence number 77.
inline HesaiBytes hesai_bytes(const HesaiModel& model, const std::vector<int>& azimuths,
                              std::uint8_t mode = 0x37, int rpm = 600) {
  HesaiBytes bytes(model.size, 0);
  const auto lasers = static_cast<std::uint8_t>(model.lasers);
  const auto blocks = static_cast<std::uint8_t>(model.blocks);
  if (model.header == 12) {
    const std::uint8_t protocol = model.name == "hesai_qt64" ? 3 : 6;
    const std::uint8_t unit = model.name == "hesai_xt32m" ? 5 : 4;
    const HesaiBytes header = {0xEE, 0xFF, protocol, 1, 0, 0, lasers, blocks, 0, unit, 2, 1};
    for (std::size_t i = 0; i < header.size(); ++i) bytes[i] = header[i];
  } else if (model.header == 8) {
    const HesaiBytes header = {0xEE, 0xFF, lasers, blocks, 0, 4, 0, 0};
    for (std::size_t i = 0; i < header.size(); ++i) bytes[i] = header[i];
  }
  for (std::size_t b = 0; b < azimuths.size(); ++b) {
    std::size_t at = hesai_block(model, b);
    if (model.header == 0) {
      put_le(bytes, at, 0xEEFF, 2);
      at += 2;
    }
    put_le(bytes, at, static_cast<std::uint32_t>(azimuths[b]), 2);
  }
  bytes[model.mode] = mode;
  put_le(bytes, model.motor, static_cast<std::uint32_t>(rpm), 2);
  const int date[] = {2023 - model.year_base, 4, 5, 6, 7, 8};
  for (std::size_t i = 0; i < 6; ++i) bytes[model.date + i] = static_cast<std::uint8_t>(date[i]);
  put_le(bytes, model.microseconds, 500'000, 4);
  put_le(bytes, model.sequence, 77, 4);
  return bytes;
}

inline void put_return(HesaiBytes& bytes, const HesaiModel& model, std::size_t block, std::size_t laser,
                       int distance, int intensity = 50) {
  const std::size_t at = hesai_block(model, block) + (model.header == 0 ? 4 : 2) +
                         laser * static_cast<std::size_t>(model.return_bytes);
  put_le(bytes, at, static_cast<std::uint32_t>(distance), 2);
  bytes[at + 2] = static_cast<std::uint8_t>(intensity);
}

}  // namespace hulltrack::test
