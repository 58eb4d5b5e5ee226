#include "core/io/pcd_reader.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <charconv>
#include <cstdint>
#include <cstring>
#include <vector>

#include "core/io/header_lines.hpp"
#include "core/io/lzf.hpp"
#include "core/io/map_file.hpp"

namespace hulltrack {
namespace {

static_assert(std::endian::native == std::endian::little, "binary PCD is little-endian");

constexpr std::size_t kMaxFields = 64;
constexpr std::size_t kMaxCount = 4096;  // values of one field

struct Field {
  std::string_view name;
  std::size_t size = 4;
  char type = 'F';
  std::size_t count = 1;
};

struct Header {
  std::vector<Field> fields;
  std::size_t points = 0;
  std::string_view data;   // ascii, binary, binary_compressed
  std::size_t record = 0;  // bytes of one point
  std::size_t values = 0;  // words of one point in ascii
};

/// Where one of x, y, z stands in a point.
struct Coordinate {
  std::size_t offset = 0;  // bytes before it in a record
  std::size_t word = 0;    // words before it in an ascii line
  std::size_t size = 4;
};

Error at_line(const HeaderLines& lines, const std::string& message) {
  return Error{"line " + std::to_string(lines.count()) + ": " + message};
}

std::optional<std::size_t> parse_count(std::string_view word) {
  std::size_t value = 0;
  const auto [end, failure] = std::from_chars(word.data(), word.data() + word.size(), value);
  return failure == std::errc{} && end == word.data() + word.size() && !word.empty() ? std::optional(value)
                                                                                     : std::nullopt;
}

/// One word for each field of a SIZE, TYPE or COUNT line, given to `set`, which says whether it is legal.
template <typename Set>
bool each_field(std::string_view words, std::vector<Field>& fields, Set set) {
  for (Field& field : fields) {
    if (!set(field, take_word(words))) {
      return false;
    }
  }
  return take_word(words).empty();
}

Result<void> check_points(const Header& header) {
  if (header.points == 0) {
    return Error{"has no points; make the map again"};
  }
  if (header.points > kMaxMapPoints) {
    return Error{"its header says " + std::to_string(header.points) + " points, at most " +
                 std::to_string(kMaxMapPoints) + " are allowed; thin the map out (5 cm voxels are enough)"};
  }
  return {};
}

class HeaderParser {
 public:
  explicit HeaderParser(HeaderLines& lines) : lines_(lines) {}

  Result<Header> parse() {
    while (header_.data.empty()) {
      const auto line = lines_.next();
      if (!line || lines_.count() > 100) {
        return Error{"its header has no DATA line; is the file cut short?"};
      }
      if (!take(*line)) {
        return at_line(lines_,
                       "`" + std::string(line->substr(0, 60)) + "` is not a legal line of a PCD header");
      }
    }
    return finish();
  }

 private:
  bool take(std::string_view line) {
    const std::string_view word = take_word(line);
    if (word.empty() || word.starts_with('#') || word == "VERSION" || word == "VIEWPOINT") {
      return true;
    }
    if (word == "FIELDS" || word == "COLUMNS") {
      return take_fields(line);
    }
    if (word == "SIZE") {
      return each_field(line, header_.fields, [](Field& field, std::string_view text) {
        field.size = parse_count(text).value_or(0);
        return field.size == 1 || field.size == 2 || field.size == 4 || field.size == 8;
      });
    }
    if (word == "TYPE") {
      return each_field(line, header_.fields, [](Field& field, std::string_view text) {
        field.type = text.empty() ? ' ' : text.front();
        return text == "F" || text == "I" || text == "U";
      });
    }
    if (word == "COUNT") {
      return each_field(line, header_.fields, [](Field& field, std::string_view text) {
        field.count = parse_count(text).value_or(0);
        return field.count >= 1 && field.count <= kMaxCount;
      });
    }
    if (word == "DATA") {
      header_.data = take_word(line);
      return header_.data == "ascii" || header_.data == "binary" || header_.data == "binary_compressed";
    }
    for (const auto& [name, value] :
         {std::pair{"WIDTH", &width_}, {"HEIGHT", &height_}, {"POINTS", &points_}}) {
      if (word == name) {
        *value = parse_count(take_word(line));
        return value->has_value();
      }
    }
    return false;
  }

  bool take_fields(std::string_view line) {
    while (header_.fields.size() <= kMaxFields) {
      const std::string_view name = take_word(line);
      if (name.empty()) {
        return !header_.fields.empty();
      }
      header_.fields.emplace_back().name = name;
    }
    return false;
  }

  Result<Header> finish() {
    if (!width_) {
      return Error{"its header has no WIDTH line; is this a PCD file?"};
    }
    if (width_.value() > kMaxMapPoints || height_.value_or(1) > kMaxMapPoints) {
      header_.points = std::max(*width_, height_.value_or(1));
    } else {
      header_.points = *width_ * height_.value_or(1);
      if (points_ && *points_ != header_.points) {
        return Error{"its header says POINTS " + std::to_string(*points_) + ", but WIDTH * HEIGHT is " +
                     std::to_string(header_.points)};
      }
    }
    for (const Field& field : header_.fields) {
      header_.record += field.size * field.count;
      header_.values += field.count;
    }
    if (const auto sane = check_points(header_); !sane) {
      return sane.error();
    }
    return header_;
  }

  HeaderLines& lines_;
  Header header_;
  std::optional<std::size_t> width_, height_, points_;
};

Result<std::array<Coordinate, 3>> find_coordinates(const Header& header) {
  std::array<Coordinate, 3> found;
  constexpr std::array<std::string_view, 3> kNames = {"x", "y", "z"};
  for (std::size_t axis = 0; axis < 3; ++axis) {
    Coordinate here;
    const auto is_it = [&](const Field& field) { return field.name == kNames[axis]; };
    const auto field = std::find_if(header.fields.begin(), header.fields.end(), is_it);
    if (field == header.fields.end() || field->type != 'F' || field->size < 4 || field->count != 1) {
      return Error{"has no field " + std::string(kNames[axis]) +
                   " of type F and size 4 or 8; save it with x y z as floats"};
    }
    for (auto before = header.fields.begin(); before != field; ++before) {
      here.offset += before->size * before->count;
      here.word += before->count;
    }
    here.size = field->size;
    found[axis] = here;
  }
  return found;
}

float load(const char* bytes, std::size_t size) {
  if (size == 8) {
    double value = 0.0;
    std::memcpy(&value, bytes, sizeof value);
    return static_cast<float>(value);
  }
  float value = 0.0F;
  std::memcpy(&value, bytes, sizeof value);
  return value;
}

Error truncated(std::size_t needed, std::size_t present) {
  return Error{"is cut short: its header promises " + std::to_string(needed) + " bytes of points, " +
               std::to_string(present) + " are there; copy the file again"};
}

Result<Cloud> parse_binary(const Header& header, const std::array<Coordinate, 3>& axes,
                           std::string_view body) {
  const std::size_t needed = header.points * header.record;
  if (body.size() < needed) {
    return truncated(needed, body.size());
  }
  Cloud cloud(header.points);
  for (std::size_t i = 0; i < header.points; ++i) {
    const char* record = body.data() + i * header.record;
    for (int axis = 0; axis < 3; ++axis) {
      const Coordinate& place = axes[static_cast<std::size_t>(axis)];
      cloud[i][axis] = load(record + place.offset, place.size);
    }
  }
  return cloud;
}

/// The body: sizes before and after (uint32 each), then LZF of all x, all y, all z, ...
Result<Cloud> parse_compressed(const Header& header, const std::array<Coordinate, 3>& axes,
                               std::string_view body) {
  std::array<std::uint32_t, 2> sizes{};
  if (body.size() < sizeof sizes) {
    return truncated(sizeof sizes, body.size());
  }
  std::memcpy(sizes.data(), body.data(), sizeof sizes);
  body.remove_prefix(sizeof sizes);
  const auto [compressed, expanded] = sizes;
  if (body.size() < compressed) {
    return truncated(compressed, body.size());
  }
  const Error damaged{"its compressed points are damaged; copy the file again or save it as DATA binary"};
  if (expanded != header.points * header.record || expanded / kLzfMaxRatio > compressed) {
    return damaged;
  }
  std::vector<std::uint8_t> bytes(expanded);
  const auto* packed = reinterpret_cast<const std::uint8_t*>(body.data());
  if (!lzf_decompress({packed, compressed}, bytes)) {
    return damaged;
  }
  Cloud cloud(header.points);
  for (int axis = 0; axis < 3; ++axis) {
    const Coordinate& place = axes[static_cast<std::size_t>(axis)];
    const char* column = reinterpret_cast<const char*>(bytes.data()) + place.offset * header.points;
    for (std::size_t i = 0; i < header.points; ++i) {
      cloud[i][axis] = load(column + i * place.size, place.size);
    }
  }
  return cloud;
}

Result<Cloud> parse_ascii(const Header& header, const std::array<Coordinate, 3>& axes, HeaderLines& lines) {
  Cloud cloud;
  cloud.reserve(std::min(header.points, lines.rest().size() / (2 * header.values) + 1));
  while (cloud.size() < header.points) {
    auto line = lines.next();
    if (!line) {
      return Error{"is cut short: its header promises " + std::to_string(header.points) + " points, " +
                   std::to_string(cloud.size()) + " are there; copy the file again"};
    }
    Point point = Point::Zero();
    for (std::size_t word = 0; word < header.values; ++word) {
      const std::string_view text = take_word(*line);
      if (text.empty()) {
        return at_line(lines, "has " + std::to_string(word) + " values, the header promises " +
                                  std::to_string(header.values));
      }
      for (int axis = 0; axis < 3; ++axis) {
        if (axes[static_cast<std::size_t>(axis)].word == word && !parse_coordinate(text, point[axis])) {
          return at_line(lines, "`" + std::string(text.substr(0, 40)) + "` is not a number");
        }
      }
    }
    cloud.push_back(point);
  }
  return cloud;
}

}  // namespace

bool is_pcd(std::string_view bytes) {
  return bytes.starts_with("# .PCD") || bytes.starts_with("VERSION") || bytes.starts_with("FIELDS");
}

Result<Cloud> parse_pcd(std::string_view bytes) {
  HeaderLines lines(bytes);
  const auto header = HeaderParser(lines).parse();
  if (!header) {
    return header.error();
  }
  const auto axes = find_coordinates(*header);
  if (!axes) {
    return axes.error();
  }
  if (header->data == "ascii") {
    return parse_ascii(*header, *axes, lines);
  }
  return header->data == "binary" ? parse_binary(*header, *axes, lines.rest())
                                  : parse_compressed(*header, *axes, lines.rest());
}

}  // namespace hulltrack
