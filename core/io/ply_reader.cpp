#include "core/io/ply_reader.hpp"

#include <algorithm>
#include <array>
#include <cstdint>
#include <cstring>
#include <utility>
#include <vector>

#include "core/io/cloud_body.hpp"
#include "core/io/header_lines.hpp"
#include "core/io/parse_number.hpp"

namespace hulltrack {
namespace {

constexpr std::size_t kMaxProperties = 256;

struct Property {
  std::string_view name;
  std::size_t size = 0;  // bytes
  bool real = false;     // float or double
  std::size_t offset = 0;
};

struct Header {
  enum class Format { none, ascii, little, big } format = Format::none;
  std::size_t points = 0;
  std::vector<Property> properties;  // of a vertex
  AxisWords axes{};                  // indices of x, y, z
  [[nodiscard]] std::size_t record() const { return properties.back().offset + properties.back().size; }
};

/// Size of a scalar type; 0 for an unknown one. Both families of names are in use.
std::size_t size_of(std::string_view type) {
  constexpr std::array<std::pair<std::string_view, std::size_t>, 16> kTypes = {{{"char", 1},
                                                                                {"int8", 1},
                                                                                {"uchar", 1},
                                                                                {"uint8", 1},
                                                                                {"short", 2},
                                                                                {"int16", 2},
                                                                                {"ushort", 2},
                                                                                {"uint16", 2},
                                                                                {"int", 4},
                                                                                {"int32", 4},
                                                                                {"uint", 4},
                                                                                {"uint32", 4},
                                                                                {"float", 4},
                                                                                {"float32", 4},
                                                                                {"double", 8},
                                                                                {"float64", 8}}};
  for (const auto& [name, size] : kTypes) {
    if (name == type) {
      return size;
    }
  }
  return 0;
}

class HeaderParser {
 public:
  explicit HeaderParser(HeaderLines& lines) : lines_(lines) {}

  Result<Header> parse() {
    lines_.skip();  // "ply"
    while (true) {
      const auto line = lines_.next();
      if (!line || lines_.count() > 1000) {
        return Error{"its header has no end_header line; is the file cut short?"};
      }
      if (*line == "end_header") {
        return finish();
      }
      if (const std::string problem = take(*line); !problem.empty()) {
        return lines_.error(problem);
      }
    }
  }

 private:
  enum class Element { none, vertex, later };

  std::string take(std::string_view line) {
    const std::string_view word = take_word(line);
    if (word == "comment" || word == "obj_info") {
      return {};
    }
    if (word == "format") {
      return take_format(take_word(line));
    }
    if (word == "element") {
      const std::string_view name = take_word(line);
      return take_element(name, take_word(line));
    }
    if (word == "property") {
      return element_ == Element::later ? std::string{} : take_property(line);
    }
    return std::string("`").append(word.substr(0, 40)) + "` is not a legal line of a PLY header";
  }

  std::string take_format(std::string_view name) {
    using Format = Header::Format;
    header_.format = name == "ascii"                  ? Format::ascii
                     : name == "binary_little_endian" ? Format::little
                     : name == "binary_big_endian"    ? Format::big
                                                      : Format::none;
    return header_.format == Format::none
               ? "the format must be ascii, binary_little_endian or binary_big_endian"
               : std::string{};
  }

  std::string take_element(std::string_view name, std::string_view count) {
    if (element_ == Element::none && name != "vertex") {
      return "the first element must be vertex; save the cloud without others";
    }
    if (element_ == Element::none) {
      const auto points = parse_number<std::size_t>(count);
      if (!points) {
        return std::string("`").append(count.substr(0, 40)) + "` is not a number of points";
      }
      header_.points = *points;
    }
    element_ = element_ == Element::none ? Element::vertex : Element::later;
    return {};
  }

  std::string take_property(std::string_view line) {
    const std::string_view type = take_word(line);
    const std::size_t size = size_of(type);
    if (element_ == Element::none || size == 0 || header_.properties.size() >= kMaxProperties) {
      return "a vertex may have scalar properties only (float x and so on), at most " +
             std::to_string(kMaxProperties);
    }
    const std::size_t offset = header_.properties.empty() ? 0 : header_.record();
    const bool real = type == "float" || type == "float32" || size == 8;
    header_.properties.push_back({take_word(line), size, real, offset});
    return {};
  }

  Result<Header> finish() {
    if (header_.format == Header::Format::none) {
      return Error{"its header has no format line; is this a PLY file?"};
    }
    constexpr std::array<std::string_view, 3> kNames = {"x", "y", "z"};
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const auto& all = header_.properties;
      const auto found = std::find_if(all.begin(), all.end(),
                                      [&](const Property& p) { return p.name == kNames[axis] && p.real; });
      if (found == all.end()) {
        return Error{"its vertices have no property float " + std::string(kNames[axis]) +
                     "; save it with x y z as floats"};
      }
      header_.axes[axis] = static_cast<std::size_t>(found - all.begin());
    }
    if (const auto sane = check_point_count(header_.points); !sane) {
      return sane.error();
    }
    return header_;
  }

  HeaderLines& lines_;
  Header header_;
  Element element_ = Element::none;
};

template <typename T>
float load(const char* bytes, bool swap) {
  std::array<char, sizeof(T)> raw{};
  std::copy_n(bytes, raw.size(), raw.begin());
  if (swap) {
    std::reverse(raw.begin(), raw.end());
  }
  T value{};
  std::memcpy(&value, raw.data(), sizeof value);
  return static_cast<float>(value);
}

Result<Cloud> parse_binary(const Header& header, std::string_view body) {
  const std::size_t record = header.record();
  if (const auto whole = check_body_size(header.points * record, body.size()); !whole) {
    return whole.error();
  }
  const bool swap = header.format == Header::Format::big;
  Cloud cloud(header.points);
  for (std::size_t i = 0; i < header.points; ++i) {
    for (int axis = 0; axis < 3; ++axis) {
      const Property& property = header.properties[header.axes[static_cast<std::size_t>(axis)]];
      const char* bytes = body.data() + i * record + property.offset;
      cloud[i][axis] = property.size == 8 ? load<double>(bytes, swap) : load<float>(bytes, swap);
    }
  }
  return cloud;
}

}  // namespace

bool is_ply(std::string_view bytes) { return bytes.starts_with("ply\n") || bytes.starts_with("ply\r\n"); }

Result<Cloud> parse_ply(std::string_view bytes) {
  HeaderLines lines(bytes);
  const auto header = HeaderParser(lines).parse();
  if (!header) {
    return header.error();
  }
  return header->format == Header::Format::ascii
             ? parse_ascii_body(lines, header->points, header->properties.size(), header->axes)
             : parse_binary(*header, lines.rest());
}

}  // namespace hulltrack
