// Ouster metadata and datagrams written by hand, independent of the encoder and of the decoder's tables.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace hulltrack::test {

struct OusterText {
  std::string mode = "1024x10";
  std::string profile = "RNG19_RFL8_SIG16_NIR16";  // empty: the key is left out
  int columns = 1024;
  std::string window = "[0, 1023]";
  std::string altitudes = "[30, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, -30]";
  std::string azimuths = "[0, 0, 10, -10, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0]";
  std::string origin = R"("lidar_origin_to_beam_origin_mm": 10)";
  std::string transform = "[-1, 0, 0, 0, 0, -1, 0, 0, 0, 0, 1, 36, 0, 0, 0, 1]";

  [[nodiscard]] std::string format() const {
    return R"({"columns_per_frame": )" + std::to_string(columns) +
           R"(, "columns_per_packet": 16, "pixels_per_column": 16, "column_window": )" + window +
           (profile.empty() ? "" : R"(, "udp_profile_lidar": ")" + profile + "\"") + "}";
  }
  [[nodiscard]] std::string beams() const {
    return R"("beam_altitude_angles": )" + altitudes + R"(, "beam_azimuth_angles": )" + azimuths + ", " +
           origin;
  }
  [[nodiscard]] std::string flat() const {
    return "{" + beams() + R"(, "lidar_to_sensor_transform": )" + transform + R"(, "lidar_mode": ")" + mode +
           R"(", "prod_sn": "122000000007", "data_format": )" + format() + "}";
  }
  [[nodiscard]] std::string nested() const {
    return R"({"beam_intrinsics": {)" + beams() + R"(}, "lidar_intrinsics": {"lidar_to_sensor_transform": )" +
           transform + R"(}, "config_params": {"lidar_mode": ")" + mode +
           R"("}, "sensor_info": {"prod_sn": "122000000007"}, "lidar_data_format": )" + format() + "}";
  }
};

/// A datagram of 16 columns and 16 rows: ids from `first_id` on, valid, `spacing_ns` apart, no returns.
class OusterBytes {
 public:
  enum class Kind { legacy, single, dual, low };

  explicit OusterBytes(Kind kind, int first_id = 0, std::uint64_t stamp_ns = 5'000'000'000,
                       std::uint64_t spacing_ns = 97'656, int frame = 3)
      : kind_(kind) {
    const bool legacy = kind == Kind::legacy;
    bytes.assign(legacy ? 16 * kLegacyColumn : 32 + 16 * column_bytes() + 32, 0);
    if (!legacy) {
      put(0, 1, 2);
      put(2, static_cast<std::uint64_t>(frame), 2);
      put(7, 122'000'000'007, 5);
    }
    for (int c = 0; c < 16; ++c) {
      put(column(c), stamp_ns + static_cast<std::uint64_t>(c) * spacing_ns, 8);
      put(column(c) + 8, static_cast<std::uint64_t>(first_id + c), 2);
      if (legacy) put(column(c) + 10, static_cast<std::uint64_t>(frame), 2);
      set_valid(c, true);
    }
  }

  [[nodiscard]] std::size_t column(int c) const {
    const auto index = static_cast<std::size_t>(c);
    return kind_ == Kind::legacy ? index * kLegacyColumn : 32 + index * column_bytes();
  }
  void set_valid(int c, bool valid) {
    if (kind_ == Kind::legacy) {
      put(column(c) + 16 + 16 * 12, valid ? 0xFFFFFFFF : 0, 4);
    } else {
      put(column(c) + 10, valid ? 1 : 0, 2);
    }
  }
  void set_id(int c, int id) { put(column(c) + 8, static_cast<std::uint64_t>(id), 2); }
  void set_stamp(int c, std::uint64_t ns) { put(column(c), ns, 8); }

  /// Range in the field's own unit; the bits beside it that are not the range's are set.
  void put_return(int c, int row, std::uint32_t range, std::uint8_t reflectivity, bool second = false) {
    const std::size_t at = pixel(c, row) + (second ? 4 : 0);
    switch (kind_) {
      case Kind::legacy:
        put(at, range | 0xF0000000, 4);
        put(at + 4, reflectivity | 0x12340000U, 4);
        break;
      case Kind::single:
        put(at, range | 0x00F80000, 4);
        put(at + 4, reflectivity | 0x12340000U, 4);
        break;
      case Kind::dual:
        put(at, range | 0x00F80000 | static_cast<std::uint32_t>(reflectivity) << 24, 4);
        break;
      case Kind::low:
        put(at, range | 0x8000, 2);
        put(at + 2, reflectivity, 1);
        break;
    }
  }

  std::vector<std::uint8_t> bytes;

  void put(std::size_t at, std::uint64_t value, int size) {
    for (int i = 0; i < size; ++i)
      bytes.at(at + static_cast<std::size_t>(i)) = static_cast<std::uint8_t>(value >> (8 * i));
  }

 private:
  static constexpr std::size_t kLegacyColumn = 16 + 16 * 12 + 4;
  [[nodiscard]] std::size_t pixel_bytes() const {
    return kind_ == Kind::dual ? 16 : kind_ == Kind::low ? 4 : 12;
  }
  [[nodiscard]] std::size_t column_bytes() const { return 12 + 16 * pixel_bytes(); }
  [[nodiscard]] std::size_t pixel(int c, int row) const {
    return column(c) + (kind_ == Kind::legacy ? 16 : 12) + static_cast<std::size_t>(row) * pixel_bytes();
  }

  Kind kind_;
};

}  // namespace hulltrack::test
