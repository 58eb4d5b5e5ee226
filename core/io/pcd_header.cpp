#include "core/io/pcd_header.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <string>
#include <utility>

#include "core/io/cloud_body.hpp"
#include "core/io/map_file.hpp"
#include "core/io/parse_number.hpp"

namespace hulltrack {
namespace {

constexpr std::size_t kMaxFields = 64;
constexpr std::size_t kMaxCount = 4096;  // values of one field

// A quaternion printed to three digits or more: four numbers, each off by 0.0005 at most, are off by 0.001
// together. One that is longer or shorter by more is none, and nobody can say which turn was meant.
constexpr double kOffUnit = 0.001;

/// One word for each field of a SIZE, TYPE or COUNT line, given to `set`, which says whether it is legal.
template <typename Set>
bool each_field(std::string_view words, std::vector<PcdField>& fields, Set set) {
  for (PcdField& field : fields) {
    if (!set(field, take_word(words))) {
      return false;
    }
  }
  return take_word(words).empty();
}

/// "tx ty tz qw qx qy qz" as the pose that it is, or what is wrong with it.
Result<Pose> parse_viewpoint(std::string_view words) {
  std::array<double, 7> v{};
  for (double& value : v) {
    const auto number = parse_number<double>(take_word(words));
    if (!number) {
      return Error{
          "VIEWPOINT must be seven finite numbers, x y z of a shift and w x y z of a unit quaternion; "
          "correct the line, or write `VIEWPOINT 0 0 0 1 0 0 0` if the points are where they belong"};
    }
    value = *number;
  }
  if (!take_word(words).empty()) {
    return Error{"VIEWPOINT has more than seven numbers; correct the line"};
  }
  const Eigen::Quaterniond q(v[3], v[4], v[5], v[6]);
  if (!(std::abs(q.norm() - 1.0) <= kOffUnit)) {
    return Error{
        "the quaternion of VIEWPOINT has the length " + std::to_string(q.norm()) +
        ", must be 1 to 0.001; correct the line, or write `VIEWPOINT 0 0 0 1 0 0 0` if the points are "
        "where they belong"};
  }
  Pose pose = Pose::Identity();
  pose.linear() = q.normalized().toRotationMatrix();
  pose.translation() = Eigen::Vector3d(v[0], v[1], v[2]);
  return pose;
}

class HeaderParser {
 public:
  explicit HeaderParser(HeaderLines& lines) : lines_(lines) {}

  Result<PcdHeader> parse() {
    while (header_.data.empty()) {
      const auto line = lines_.next();
      if (!line || lines_.count() > 100) {
        return Error{"its header has no DATA line; is the file cut short?"};
      }
      if (std::string_view words = *line; take_word(words) == "VIEWPOINT") {
        const auto viewpoint = parse_viewpoint(words);
        if (!viewpoint) {
          return lines_.error(viewpoint.error().message);
        }
        header_.viewpoint = *viewpoint;
      } else if (!take(*line)) {
        return lines_.error(std::string("`").append(line->substr(0, 60)) +
                            "` is not a legal line of a PCD header");
      }
    }
    return finish();
  }

 private:
  bool take(std::string_view line) {
    const std::string_view word = take_word(line);
    if (word.empty() || word.starts_with('#') || word == "VERSION") {
      return true;
    }
    if (word == "FIELDS" || word == "COLUMNS") {
      return take_fields(line);
    }
    if (word == "SIZE") {
      return each_field(line, header_.fields, [](PcdField& field, std::string_view text) {
        field.size = parse_number<std::size_t>(text).value_or(0);
        return field.size == 1 || field.size == 2 || field.size == 4 || field.size == 8;
      });
    }
    if (word == "TYPE") {
      return each_field(line, header_.fields, [](PcdField& field, std::string_view text) {
        field.type = text.empty() ? ' ' : text.front();
        return text == "F" || text == "I" || text == "U";
      });
    }
    if (word == "COUNT") {
      return each_field(line, header_.fields, [](PcdField& field, std::string_view text) {
        field.count = parse_number<std::size_t>(text).value_or(0);
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
        *value = parse_number<std::size_t>(take_word(line));
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

  Result<PcdHeader> finish() {
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
    for (const PcdField& field : header_.fields) {
      header_.record += field.size * field.count;
      header_.values += field.count;
    }
    if (const auto sane = check_point_count(header_.points); !sane) {
      return sane.error();
    }
    return header_;
  }

  HeaderLines& lines_;
  PcdHeader header_;
  std::optional<std::size_t> width_, height_, points_;
};

}  // namespace

Result<PcdHeader> parse_pcd_header(HeaderLines& lines) { return HeaderParser(lines).parse(); }

Result<PcdAxes> find_coordinates(const PcdHeader& header) {
  PcdAxes found;
  constexpr std::array<std::string_view, 3> kNames = {"x", "y", "z"};
  for (std::size_t axis = 0; axis < 3; ++axis) {
    PcdCoordinate here;
    const auto is_it = [&](const PcdField& field) { return field.name == kNames[axis]; };
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

}  // namespace hulltrack
