// What the points of PCD and PLY files have in common, once the header is read: counts, bytes, text.
//
// An error has no file name; a line is named where there is one. Counts are checked against the bytes that
// are there before memory is taken. Thread rule: plain functions.
#pragma once

#include <array>
#include <cstddef>

#include "core/base/result.hpp"
#include "core/geometry/cloud.hpp"
#include "core/geometry/se3.hpp"
#include "core/io/header_lines.hpp"

namespace hulltrack {

/// Where x, y and z stand among the values of a point, from 0.
using AxisWords = std::array<std::size_t, 3>;

/// Is `points`, as a header promises them, a number that a map can have? (1 to kMaxMapPoints)
[[nodiscard]] Result<void> check_point_count(std::size_t points);

/// Are the `promised` bytes of points there?
[[nodiscard]] Result<void> check_body_size(std::size_t promised, std::size_t present);

/// Where a file's own transform puts its points. In double: a point may be far from the file's origin and
/// near to ours.
class FileFrame {
 public:
  FileFrame() = default;
  explicit FileFrame(const Pose& moved_by)
      : moved_by_(moved_by), moves_(moved_by.matrix() != Eigen::Matrix4d::Identity()) {}
  [[nodiscard]] Point place(const Eigen::Vector3d& p) const {
    return (moves_ ? Eigen::Vector3d(moved_by_ * p) : p).cast<float>();
  }

 private:
  Pose moved_by_ = Pose::Identity();
  bool moves_ = false;  // otherwise points keep every bit, NaN and infinity too
};

/// `points` lines of at least `words` numbers each (> 0, all of `axes` below it).
[[nodiscard]] Result<Cloud> parse_ascii_body(HeaderLines& lines, std::size_t points, std::size_t words,
                                             const AxisWords& axes, const FileFrame& frame = {});

}  // namespace hulltrack
