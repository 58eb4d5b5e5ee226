#include "core/io/cloud_body.hpp"

#include <algorithm>
#include <string>

#include "core/base/text.hpp"
#include "core/io/map_file.hpp"
#include "core/io/parse_number.hpp"

namespace hulltrack {
namespace {

Error cut_short(std::size_t promised, const char* unit, std::size_t present) {
  return Error{"is cut short: its header promises " + std::to_string(promised) + ' ' + unit + ", " +
               std::to_string(present) + " are there; copy the file again"};
}

}  // namespace

Result<void> check_point_count(std::size_t points) {
  if (points == 0) {
    return Error{"has no points; make the map again"};
  }
  if (points > kMaxMapPoints) {
    return Error{"its header says " + std::to_string(points) + " points, at most " +
                 std::to_string(kMaxMapPoints) + " are allowed; thin the map out (5 cm voxels are enough)"};
  }
  return {};
}

Result<void> check_body_size(std::size_t promised, std::size_t present) {
  return present < promised ? cut_short(promised, "bytes of points", present) : Result<void>{};
}

Result<Cloud> parse_ascii_body(HeaderLines& lines, std::size_t points, std::size_t words,
                               const AxisWords& axes, const FileFrame& frame) {
  Cloud cloud;
  cloud.reserve(std::min(points, lines.rest().size() / (2 * words) + 1));  // a digit and a blank each
  while (cloud.size() < points) {
    auto line = lines.next();
    if (!line) {
      return cut_short(points, "points", cloud.size());
    }
    Eigen::Vector3d point = Eigen::Vector3d::Zero();
    for (std::size_t word = 0; word < words; ++word) {
      const std::string_view text = take_word(*line);
      if (text.empty()) {
        return lines.error("has " + counted(word, "value") + ", the header promises " +
                           std::to_string(words));
      }
      for (int axis = 0; axis < 3; ++axis) {
        if (axes[static_cast<std::size_t>(axis)] == word && !parse_coordinate(text, point[axis])) {
          return lines.error("value " + std::to_string(word + 1) + " is `" + std::string(text.substr(0, 40)) +
                             "`, must be a number");
        }
      }
    }
    cloud.push_back(frame.place(point));
  }
  return cloud;
}

}  // namespace hulltrack
