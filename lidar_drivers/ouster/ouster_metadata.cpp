#include "lidar_drivers/ouster/ouster_metadata.hpp"

#include <algorithm>
#include <cmath>
#include <fstream>
#include <initializer_list>
#include <iterator>
#include <nlohmann/json.hpp>
#include <utility>

#include "core/base/text.hpp"

namespace hulltrack::ouster {

namespace {

using Json = nlohmann::json;

/// Several times the largest that a sensor gives (with 128 beams some 15 KB).
constexpr std::size_t kMaxFileBytes = 1'000'000;
/// A rotation matrix of four printed decimals is as good as this.
constexpr double kRotationTolerance = 1e-3;

struct Mode {
  std::string_view name;
  int columns, frames_per_second;
};
constexpr Mode kModes[] = {{"512x10", 512, 10},
                           {"512x20", 512, 20},
                           {"1024x10", 1024, 10},
                           {"1024x20", 1024, 20},
                           {"2048x10", 2048, 10}};

template <typename Rows>
std::string names_of(const Rows& rows) {
  std::string names;
  for (const auto& row : rows) names += (names.empty() ? "" : ", ") + std::string(row.name);
  return names;
}

/// Text from the file, short enough for a message and on one line.
std::string quoted(const std::string& text) {
  std::string shown = text.substr(0, 40);
  std::ranges::replace_if(
      shown, [](char c) { return c >= 0 && c < ' '; }, '?');
  return "\"" + shown + "\"";
}

/// Thrown and caught in this file only.
struct Problem {
  std::string message;
};

/// A key of the file, looked for in the sections where either shape may have it.
class Key {
 public:
  /// The section "" is the top level.
  Key(const Json& root, std::initializer_list<const char*> sections, const char* name) : name_(name) {
    for (const char* section : sections) {
      const Json* place = &root;
      if (*section != '\0') {
        const auto it = root.find(section);
        if (it == root.end() || !it->is_object()) continue;
        place = &*it;
      }
      const auto it = place->find(name);
      if (it == place->end()) continue;
      value_ = &*it;
      if (*section != '\0') name_ = std::string(section) + "." + name;
      return;
    }
  }

  [[nodiscard]] bool given() const { return value_ != nullptr; }

  [[noreturn]] void refuse(const std::string& what) const { throw Problem{name_ + ": " + what}; }

  [[nodiscard]] const Json& value(const std::string& allowed) const {
    if (value_ == nullptr) refuse("is missing; allowed is " + allowed);
    return *value_;
  }

  [[nodiscard]] std::string text(const std::string& allowed) const {
    const Json& json = value(allowed);
    if (!json.is_string()) refuse("is no text; allowed is " + allowed);
    return json.get<std::string>();
  }

  [[nodiscard]] int integer(int low, int high) const {
    const std::string allowed = format_text("a whole number in [%d, %d]", low, high);
    const double number = checked(value(allowed), low, high, allowed, "");
    if (number != std::floor(number)) refuse(format_text("is %g; allowed is ", number) + allowed);
    return static_cast<int>(number);
  }

  [[nodiscard]] double number(double low, double high) const {
    const std::string allowed = format_text("a number in [%g, %g]", low, high);
    return checked(value(allowed), low, high, allowed, "");
  }

  [[nodiscard]] std::vector<double> numbers(std::size_t least, std::size_t most, double low,
                                            double high) const {
    std::string allowed = least == most ? format_text("%zu", least) : format_text("%zu to %zu", least, most);
    allowed = "a list of " + allowed + format_text(" numbers in [%g, %g]", low, high);
    const Json& json = value(allowed);
    if (!json.is_array()) refuse("is no list; allowed is " + allowed);
    if (json.size() < least || json.size() > most)
      refuse(format_text("has %zu values; allowed is ", json.size()) + allowed);
    std::vector<double> values;
    for (std::size_t i = 0; i < json.size(); ++i)
      values.push_back(checked(json[i], low, high, allowed, format_text("value %zu ", i)));
    return values;
  }

 private:
  [[nodiscard]] double checked(const Json& json, double low, double high, const std::string& allowed,
                               const std::string& which) const {
    if (!json.is_number()) refuse(which + "is no number; allowed is " + allowed);
    const auto number = json.get<double>();
    if (!(number >= low && number <= high)) {
      refuse(which + format_text("is %g; allowed is ", number) + allowed);
    }
    return number;
  }

  const Json* value_ = nullptr;
  std::string name_;
};

void read_layout(const Json& root, Metadata& m) {
  const Key mode(root, {"config_params", ""}, "lidar_mode");
  const std::string modes = "one of " + names_of(kModes);
  const std::string mode_name = mode.text(modes);
  const auto* found = std::ranges::find(kModes, mode_name, &Mode::name);
  if (found == std::end(kModes)) mode.refuse("is " + quoted(mode_name) + "; allowed is " + modes);
  m.columns_per_frame = found->columns;
  m.frames_per_second = found->frames_per_second;

  const auto format = {"lidar_data_format", "data_format"};
  const Key columns(root, format, "columns_per_frame");
  if (columns.given()) {
    const int told = columns.integer(1, 65'536);
    if (told != m.columns_per_frame)
      columns.refuse(format_text("is %d, but lidar_mode says %d", told, m.columns_per_frame));
  }
  const Key packet(root, format, "columns_per_packet");
  if (packet.given()) {
    m.columns_per_packet = static_cast<std::size_t>(packet.integer(1, kMaxColumns));
    if (static_cast<std::size_t>(m.columns_per_frame) % m.columns_per_packet != 0) {
      packet.refuse(format_text("is %zu, which does not divide the frame's %d columns", m.columns_per_packet,
                                m.columns_per_frame));
    }
  }
  m.window_first = 0;
  m.window_last = m.columns_per_frame - 1;
  const Key window(root, format, "column_window");
  if (window.given()) {
    const auto ends = window.numbers(2, 2, 0.0, m.columns_per_frame - 1);
    if (std::ranges::any_of(ends, [](double end) { return end != std::floor(end); }))
      window.refuse("is not of whole numbers; allowed are two measurement ids");
    m.window_first = static_cast<int>(ends[0]);
    m.window_last = static_cast<int>(ends[1]);
  }
  const Key profile(root, {"lidar_data_format", "data_format", "config_params", ""}, "udp_profile_lidar");
  if (!profile.given()) return;  // firmware before 2.2 has one only
  const std::string profiles = "one of " + names_of(kLayouts);
  const std::string profile_name = profile.text(profiles);
  const auto* layout = std::ranges::find(kLayouts, profile_name, &Layout::name);
  if (layout == std::end(kLayouts)) profile.refuse("is " + quoted(profile_name) + "; allowed is " + profiles);
  m.profile = layout->profile;
}

void read_beams(const Json& root, Metadata& m) {
  const auto place = {"beam_intrinsics", ""};
  const Key altitude(root, place, "beam_altitude_angles");
  const Key azimuth(root, place, "beam_azimuth_angles");
  const auto altitudes = altitude.numbers(16, 128, -90.0, 90.0);
  const auto azimuths = azimuth.numbers(altitudes.size(), altitudes.size(), -90.0, 90.0);
  for (std::size_t i = 0; i < altitudes.size(); ++i)
    m.beams.push_back({radians(altitudes[i]), radians(azimuths[i])});
  const std::size_t rows = m.beams.size();
  if (rows != 16 && rows != 32 && rows != 64 && rows != 128)
    altitude.refuse(format_text("has %zu values; allowed are 16, 32, 64 and 128", rows));
  const Key pixels(root, {"lidar_data_format", "data_format"}, "pixels_per_column");
  if (pixels.given() && static_cast<std::size_t>(pixels.integer(16, 128)) != rows)
    pixels.refuse(format_text("differs from the %zu beam_altitude_angles", rows));

  const Key transform(root, place, "beam_to_lidar_transform");
  if (transform.given()) {
    const auto matrix = transform.numbers(16, 16, -1000.0, 1000.0);
    m.beam_origin_x = matrix[3];
    m.beam_origin_z = matrix[11];
  } else {
    m.beam_origin_x = Key(root, place, "lidar_origin_to_beam_origin_mm").number(0.0, 1000.0);
  }
  m.beam_origin_distance = std::hypot(m.beam_origin_x, m.beam_origin_z);
}

void read_sensor(const Json& root, Metadata& m) {
  const Key key(root, {"lidar_intrinsics", ""}, "lidar_to_sensor_transform");
  const auto matrix = key.numbers(16, 16, -1000.0, 1000.0);
  Eigen::Matrix3d rotation;
  for (int row = 0; row < 3; ++row) {
    for (int column = 0; column < 3; ++column)
      rotation(row, column) = matrix[static_cast<std::size_t>(4 * row + column)];
  }
  const bool orthonormal =
      (rotation * rotation.transpose() - Eigen::Matrix3d::Identity()).cwiseAbs().maxCoeff() <
      kRotationTolerance;
  const bool last_row = matrix[12] == 0.0 && matrix[13] == 0.0 && matrix[14] == 0.0 && matrix[15] == 1.0;
  if (!orthonormal || rotation.determinant() < 0.0 || !last_row)
    key.refuse("is no rigid transform; allowed is a rotation, a translation in mm and the row 0, 0, 0, 1");
  m.lidar_to_sensor.linear() = rotation;
  m.lidar_to_sensor.translation() = Eigen::Vector3d(matrix[3], matrix[7], matrix[11]) * 1e-3;

  const Key serial(root, {"sensor_info", ""}, "prod_sn");
  if (!serial.given()) return;
  const std::string digits = serial.text("the serial number's digits");
  const bool number = !digits.empty() && digits.size() <= 12 &&
                      std::ranges::all_of(digits, [](char c) { return c >= '0' && c <= '9'; });
  m.serial = number ? std::stoull(digits) : 0;
}

/// A mode that is not known changes nothing but what is said of the clock, so it is none of the file's
/// errors. A sync pulse counts seconds since power-on unless an NMEA message brings the date (firmware
/// manual, "Time Synchronization").
ClockReference read_clock(const Json& root) {
  const auto place = {"config_params", ""};
  const auto is = [&](const char* name, std::string_view value) {
    const Key key(root, place, name);
    return key.given() && key.text("a mode") == value;
  };
  if (is("timestamp_mode", "TIME_FROM_INTERNAL_OSC")) return ClockReference::none;
  if (is("timestamp_mode", "TIME_FROM_PTP_1588")) return ClockReference::ptp;
  if (!is("timestamp_mode", "TIME_FROM_SYNC_PULSE_IN")) return ClockReference::unknown;
  return is("multipurpose_io_mode", "INPUT_NMEA_UART") ? ClockReference::gps : ClockReference::pulse;
}

}  // namespace

Result<Metadata> parse_metadata(std::string_view json, const std::string& name) {
  try {
    const Json root = Json::parse(json);
    if (!root.is_object()) return Error{name + ": is no JSON object, as an Ouster's metadata is"};
    Metadata metadata;
    read_layout(root, metadata);
    read_beams(root, metadata);
    read_sensor(root, metadata);
    metadata.clock_reference = read_clock(root);
    if (metadata.packet_bytes() > kMaxPacketBytes) {
      return Error{name + format_text(": columns_per_packet: %zu columns make a datagram of %zu bytes; UDP "
                                      "carries %zu",
                                      metadata.columns_per_packet, metadata.packet_bytes(), kMaxPacketBytes)};
    }
    return metadata;
  } catch (const Problem& problem) {
    return Error{name + ": " + problem.message};
  } catch (const Json::parse_error& error) {
    return Error{name + format_text(": is not JSON: wrong at byte %zu", error.byte)};
  } catch (const Json::exception&) {
    return Error{name + ": is not JSON: a number is too large"};
  }
}

Result<Metadata> read_metadata(const std::filesystem::path& file) {
  std::ifstream stream(file, std::ios::binary);
  if (!stream) return Error{file.string() + ": cannot be opened"};
  std::string text(kMaxFileBytes + 1, '\0');
  stream.read(text.data(), static_cast<std::streamsize>(text.size()));
  if (stream.bad()) return Error{file.string() + ": cannot be read"};
  text.resize(static_cast<std::size_t>(stream.gcount()));
  if (text.size() > kMaxFileBytes) {
    return Error{file.string() +
                 format_text(": is larger than %zu bytes, so no sensor's metadata", kMaxFileBytes)};
  }
  return parse_metadata(text, file.string());
}

}  // namespace hulltrack::ouster
