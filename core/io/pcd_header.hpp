// The header of a PCD file (Point Cloud Library's format 0.6, 0.7): what a point consists of, and how many.
//
// Strict on what is used (FIELDS, SIZE, TYPE, COUNT, WIDTH, HEIGHT, VIEWPOINT, POINTS, DATA); VERSION and
// comments are passed over. Every number is bounded, so that points * record cannot overflow.
// Views into the bytes given. An error has no file name; a line is named where there is one.
#pragma once

#include <array>
#include <cstddef>
#include <string_view>
#include <vector>

#include "core/base/result.hpp"
#include "core/geometry/se3.hpp"
#include "core/io/header_lines.hpp"

namespace hulltrack {

struct PcdField {
  std::string_view name;
  std::size_t size = 4;  // bytes of a value: 1, 2, 4, 8
  char type = 'F';       // F, I, U
  std::size_t count = 1;
};

struct PcdHeader {
  std::vector<PcdField> fields;
  std::size_t points = 0;
  std::string_view data;              // ascii, binary, binary_compressed
  std::size_t record = 0;             // bytes of one point
  std::size_t values = 0;             // words of one point in ascii
  Pose viewpoint = Pose::Identity();  // VIEWPOINT: takes the file's points to where they are meant to be
};

/// Where one of x, y, z stands in a point.
struct PcdCoordinate {
  std::size_t offset = 0;  // bytes before it in a record
  std::size_t word = 0;    // words before it in an ascii line
  std::size_t size = 4;    // 4 or 8
};
using PcdAxes = std::array<PcdCoordinate, 3>;

/// Takes the header off `lines`, its DATA line included.
[[nodiscard]] Result<PcdHeader> parse_pcd_header(HeaderLines& lines);

[[nodiscard]] Result<PcdAxes> find_coordinates(const PcdHeader& header);

}  // namespace hulltrack
