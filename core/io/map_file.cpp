#include "core/io/map_file.hpp"

#include <algorithm>
#include <cerrno>
#include <cmath>
#include <cstring>
#include <fstream>
#include <string>
#include <string_view>
#include <utility>

#include "core/base/text.hpp"
#include "core/io/pcd_reader.hpp"
#include "core/io/ply_reader.hpp"

namespace hulltrack {
namespace {

constexpr std::uintmax_t kMaxFile = std::uintmax_t{4} << 30;  // bytes

Result<std::string> read_bytes(const std::filesystem::path& file) {
  std::error_code failure;
  const auto status = std::filesystem::status(file, failure);
  if (std::filesystem::exists(status) && !std::filesystem::is_regular_file(status)) {
    return Error{"is not a file; name a PCD or PLY file"};
  }
  errno = 0;
  std::ifstream stream(file, std::ios::binary);
  if (!stream) {
    return Error{std::string("cannot be opened: ") + std::strerror(errno) +
                 "; name an existing PCD or PLY file"};
  }
  const std::uintmax_t size = std::filesystem::file_size(file, failure);
  if (failure || size > kMaxFile) {
    return Error{failure ? "cannot be read: " + failure.message() : "is larger than 4 GiB; thin the map out"};
  }
  std::string bytes(static_cast<std::size_t>(size), '\0');
  stream.read(bytes.data(), static_cast<std::streamsize>(bytes.size()));
  if (stream.bad()) {
    return Error{std::string("cannot be read: ") + std::strerror(errno)};
  }
  bytes.resize(static_cast<std::size_t>(stream.gcount()));
  return bytes;
}

/// Of what is in the file, used or not.
Result<MapFile> parse(std::string_view bytes) {
  if (bytes.empty()) {
    return Error{"is empty; copy the file again or make the map again"};
  }
  if (is_pcd(bytes)) {
    auto pcd = parse_pcd(bytes);
    return pcd ? MapFile{std::move(pcd->points), 0, pcd->viewpoint} : Result<MapFile>(pcd.error());
  }
  if (is_ply(bytes)) {
    auto points = parse_ply(bytes);
    return points ? MapFile{std::move(points).value()} : Result<MapFile>(points.error());
  }
  return Error{"is neither a PCD nor a PLY file; convert the map to one of these"};
}

bool usable(const Point& p) { return (p.array().abs() <= kMaxMapCoordinate).all(); }  // false for NaN

Result<MapFile> keep_usable(MapFile map) {
  const std::size_t all = map.cloud.size();
  std::erase_if(map.cloud, [](const Point& p) { return !usable(p); });
  map.dropped = all - map.cloud.size();
  if (map.cloud.size() <= map.dropped) {
    return Error{std::to_string(map.dropped) + " of its " + std::to_string(all) +
                 " points are not finite or farther than 10 km from the origin; make the map again in metres "
                 "and with its origin at the berth"};
  }
  return map;
}

}  // namespace

Result<MapFile> read_map_file(const std::filesystem::path& file) {
  const auto in_file = [&](const Error& error) { return Error{file.string() + ": " + error.message}; };
  const auto bytes = read_bytes(file);
  if (!bytes) {
    return in_file(bytes.error());
  }
  auto all = parse(*bytes);
  if (!all) {
    return in_file(all.error());
  }
  auto map = keep_usable(std::move(all).value());
  return map ? std::move(map) : Result<MapFile>(in_file(map.error()));
}

std::vector<std::string> remarks_on(const std::filesystem::path& file, const MapFile& map) {
  std::vector<std::string> remarks;
  if (map.dropped > 0) {
    remarks.push_back(file.string() + ": " + std::to_string(map.dropped) + " of its " +
                      counted(map.dropped + map.cloud.size(), "point") +
                      " are no numbers or farther than 10 km from the origin and were left out; look whether "
                      "a part of the hull is missing in it, and make the map again if so");
  }
  if (map.moved_by.matrix() != Eigen::Matrix4d::Identity()) {
    const Eigen::Vector3d t = map.moved_by.translation();
    const double turn = degrees(Eigen::AngleAxisd(map.moved_by.linear()).angle());
    remarks.push_back(file.string() +
                      format_text(": its VIEWPOINT shifts the points by %.3f, %.3f, %.3f m and turns them by "
                                  "%.3f deg, and so they are used; if they lie in H as they stand in the "
                                  "file, write `VIEWPOINT 0 0 0 1 0 0 0` there",
                                  t.x(), t.y(), t.z(), turn));
  }
  return remarks;
}

}  // namespace hulltrack
