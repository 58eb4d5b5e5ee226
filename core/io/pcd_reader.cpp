#include "core/io/pcd_reader.hpp"

#include <array>
#include <bit>
#include <cstdint>
#include <cstring>
#include <utility>
#include <vector>

#include "core/io/cloud_body.hpp"
#include "core/io/lzf.hpp"
#include "core/io/pcd_header.hpp"

namespace hulltrack {
namespace {

static_assert(std::endian::native == std::endian::little, "binary PCD is little-endian");

double load(const char* bytes, std::size_t size) {
  if (size == 8) {
    double value = 0.0;
    std::memcpy(&value, bytes, sizeof value);
    return value;
  }
  float value = 0.0F;
  std::memcpy(&value, bytes, sizeof value);
  return value;
}

Result<Cloud> parse_binary(const PcdHeader& header, const PcdAxes& axes, std::string_view body) {
  const std::size_t needed = header.points * header.record;
  if (const auto whole = check_body_size(needed, body.size()); !whole) {
    return whole.error();
  }
  const FileFrame frame(header.viewpoint);
  Cloud cloud(header.points);
  for (std::size_t i = 0; i < header.points; ++i) {
    const char* record = body.data() + i * header.record;
    Eigen::Vector3d point;
    for (int axis = 0; axis < 3; ++axis) {
      const PcdCoordinate& place = axes[static_cast<std::size_t>(axis)];
      point[axis] = load(record + place.offset, place.size);
    }
    cloud[i] = frame.place(point);
  }
  return cloud;
}

/// The body: sizes before and after (uint32 each), then LZF of all x, all y, all z, ...
Result<Cloud> parse_compressed(const PcdHeader& header, const PcdAxes& axes, std::string_view body) {
  std::array<std::uint32_t, 2> sizes{};
  if (const auto whole = check_body_size(sizeof sizes, body.size()); !whole) {
    return whole.error();
  }
  std::memcpy(sizes.data(), body.data(), sizeof sizes);
  body.remove_prefix(sizeof sizes);
  const auto [compressed, expanded] = sizes;
  if (const auto whole = check_body_size(compressed, body.size()); !whole) {
    return whole.error();
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
  const FileFrame frame(header.viewpoint);
  Cloud cloud(header.points);
  for (std::size_t i = 0; i < header.points; ++i) {
    Eigen::Vector3d point;
    for (int axis = 0; axis < 3; ++axis) {
      const PcdCoordinate& place = axes[static_cast<std::size_t>(axis)];
      const char* column = reinterpret_cast<const char*>(bytes.data()) + place.offset * header.points;
      point[axis] = load(column + i * place.size, place.size);
    }
    cloud[i] = frame.place(point);
  }
  return cloud;
}

Result<Cloud> parse_body(const PcdHeader& header, const PcdAxes& axes, HeaderLines& lines) {
  if (header.data == "ascii") {
    return parse_ascii_body(lines, header.points, header.values, {axes[0].word, axes[1].word, axes[2].word},
                            FileFrame(header.viewpoint));
  }
  return header.data == "binary" ? parse_binary(header, axes, lines.rest())
                                 : parse_compressed(header, axes, lines.rest());
}

}  // namespace

bool is_pcd(std::string_view bytes) {
  return bytes.starts_with("# .PCD") || bytes.starts_with("VERSION") || bytes.starts_with("FIELDS");
}

Result<PcdCloud> parse_pcd(std::string_view bytes) {
  HeaderLines lines(bytes);
  const auto header = parse_pcd_header(lines);
  if (!header) {
    return header.error();
  }
  const auto axes = find_coordinates(*header);
  if (!axes) {
    return axes.error();
  }
  auto points = parse_body(*header, *axes, lines);
  if (!points) {
    return points.error();
  }
  return PcdCloud{std::move(points).value(), header->viewpoint};
}

}  // namespace hulltrack
