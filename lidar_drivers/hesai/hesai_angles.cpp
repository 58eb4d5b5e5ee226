#include "lidar_drivers/hesai/hesai_angles.hpp"

#include <algorithm>
#include <cctype>
#include <charconv>
#include <cmath>
#include <cstdio>
#include <fstream>
#include <optional>
#include <string>

namespace hulltrack::hesai {

namespace {

constexpr std::size_t kMaxBytes = std::size_t{64} * 1024;
/// Units differ from the design by some 0.2 deg; models with as many lasers differ by 4 at the top.
constexpr double kMaxFromDesign = 2.0;  // deg
constexpr std::size_t kCheckSumDigits = 64;

std::string_view trimmed(std::string_view text) {
  constexpr std::string_view kBlanks = " \t\r";
  const auto first = text.find_first_not_of(kBlanks);
  if (first == std::string_view::npos) return {};
  return text.substr(first, text.find_last_not_of(kBlanks) - first + 1);
}

std::string lower(std::string_view text) {
  std::string result(text);
  std::ranges::transform(result, result.begin(), [](unsigned char c) { return std::tolower(c); });
  return result;
}

/// Takes the next part up to `separator` off the front of `rest`, trimmed.
std::string_view take(std::string_view& rest, char separator) {
  const auto end = rest.find(separator);
  const std::string_view part = rest.substr(0, end);
  rest.remove_prefix(end == std::string_view::npos ? rest.size() : end + 1);
  return trimmed(part);
}

template <typename T>
std::optional<T> number(std::string_view text) {
  T value{};
  const auto [end, failure] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (failure != std::errc{} || end != text.data() + text.size()) return std::nullopt;
  return value;
}

bool is_check_sum(std::string_view line) {
  return line.size() == kCheckSumDigits &&
         std::ranges::all_of(line, [](unsigned char c) { return std::isxdigit(c); });
}

/// One file on its way to a table.
class AngleReader {
 public:
  AngleReader(std::string_view name, const ModelTable& model)
      : name_(name), model_(model), angles_(model.lasers), line_of_(model.lasers, 0) {}

  Result<void> read_line(std::string_view text) {
    ++line_;
    const std::string_view line = trimmed(text);
    if (line.empty() || line.front() == '#' || is_check_sum(line)) return {};
    const std::string word = lower(line);
    if (!header_seen_ && word.starts_with("eeff")) return {};
    if (!header_seen_) return read_header(word);
    return read_laser(line);
  }

  Result<std::vector<LaserAngles>> finish() {
    if (!header_seen_) return Error{name_ + ": holds no line `Channel,Elevation,Azimuth`"};
    const auto missing = std::ranges::find(line_of_, 0);
    if (missing == line_of_.end()) return std::move(angles_);
    return Error{name_ + ": channel " + std::to_string(missing - line_of_.begin() + 1) + " is missing; a " +
                 std::string(model_.name) + " has the channels 1 to " + std::to_string(model_.lasers)};
  }

 private:
  Result<void> read_header(std::string_view line) {
    std::string_view rest = line;
    const std::string_view channel = take(rest, ',');
    const bool known = (channel == "channel" || channel == "laser id") && take(rest, ',') == "elevation" &&
                       take(rest, ',') == "azimuth" && rest.empty();
    if (!known)
      return error("the first line must be `Channel,Elevation,Azimuth`, it is `" +
                   std::string(line.substr(0, 80)) + "`");
    header_seen_ = true;
    return {};
  }

  Result<void> read_laser(std::string_view line) {
    const auto fields = static_cast<std::size_t>(std::ranges::count(line, ',')) + 1;
    if (fields != 3) return error("must have 3 fields, has " + std::to_string(fields));
    std::string_view rest = line;
    const std::string_view channel_text = take(rest, ',');
    const auto channel = number<std::size_t>(channel_text);
    if (!channel || *channel < 1 || *channel > model_.lasers) {
      return error("channel is \"" + std::string(channel_text.substr(0, 40)) + "\"; a " +
                   std::string(model_.name) + " has the channels 1 to " + std::to_string(model_.lasers));
    }
    const std::size_t laser = *channel - 1;
    if (line_of_[laser] != 0) {
      return error("channel " + std::to_string(*channel) + " stands in line " +
                   std::to_string(line_of_[laser]) + " already");
    }
    line_of_[laser] = line_;
    const LaserAngles& design = model_.nominal[laser];
    const auto elevation = read_angle("elevation", take(rest, ','), design.elevation_deg);
    if (!elevation) return elevation.error();
    const auto azimuth = read_angle("azimuth", take(rest, ','), design.azimuth_deg);
    if (!azimuth) return azimuth.error();
    angles_[laser] = {*elevation, *azimuth};
    return {};
  }

  Result<double> read_angle(const char* what, std::string_view text, double design) const {
    const auto value = number<double>(text);
    if (value && std::abs(*value - design) <= kMaxFromDesign) return *value;
    char range[64];
    std::snprintf(range, sizeof range, "%.2f to %.2f", design - kMaxFromDesign, design + kMaxFromDesign);
    return error(std::string(what) + " is \"" + std::string(text.substr(0, 40)) +
                 "\"; must be a number of degrees from " + range + " for this channel of a " +
                 std::string(model_.name));
  }

  Error error(const std::string& message) const {
    return Error{name_ + ':' + std::to_string(line_) + ": " + message};
  }

  std::string name_;
  const ModelTable& model_;
  std::vector<LaserAngles> angles_;
  std::vector<int> line_of_;  // each laser's; 0 = not there yet
  int line_ = 0;
  bool header_seen_ = false;
};

}  // namespace

Result<std::vector<LaserAngles>> parse_angles(std::string_view content, std::string_view name,
                                              const ModelTable& model) {
  constexpr std::string_view kByteOrderMark = "\xEF\xBB\xBF";
  if (content.starts_with(kByteOrderMark)) content.remove_prefix(kByteOrderMark.size());
  AngleReader reader(name, model);
  while (!content.empty()) {
    if (const auto read = reader.read_line(take(content, '\n')); !read.ok()) return read.error();
  }
  return reader.finish();
}

Result<std::vector<LaserAngles>> load_angles(const std::filesystem::path& file, const ModelTable& model) {
  if (file.empty()) {
    const auto end = model.nominal.begin() + static_cast<std::ptrdiff_t>(model.lasers);
    return std::vector<LaserAngles>(model.nominal.begin(), end);
  }
  std::ifstream stream(file, std::ios::binary);
  std::error_code failure;
  if (!stream || std::filesystem::is_directory(file, failure))
    return Error{file.string() + ": cannot be opened as an angle correction file"};
  std::string content(kMaxBytes + 1, '\0');
  stream.read(content.data(), static_cast<std::streamsize>(content.size()));
  if (stream.bad()) return Error{file.string() + ": cannot be read"};
  content.resize(static_cast<std::size_t>(stream.gcount()));
  if (content.size() > kMaxBytes)
    return Error{file.string() + ": is longer than " + std::to_string(kMaxBytes) +
                 " bytes; is this an angle correction file?"};
  return parse_angles(content, file.string(), model);
}

}  // namespace hulltrack::hesai
