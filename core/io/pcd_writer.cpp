#include "core/io/pcd_writer.hpp"

#include <bit>
#include <cassert>
#include <cerrno>
#include <cstring>
#include <fstream>
#include <vector>

namespace hulltrack {
namespace {

static_assert(std::endian::native == std::endian::little, "binary PCD is little-endian");

std::string header(std::size_t points, bool with_intensity) {
  const std::string count = std::to_string(points);
  return std::string("# .PCD v0.7 - Point Cloud Data file format\nVERSION 0.7\n") +
         (with_intensity ? "FIELDS x y z intensity\nSIZE 4 4 4 4\nTYPE F F F F\nCOUNT 1 1 1 1\n"
                         : "FIELDS x y z\nSIZE 4 4 4\nTYPE F F F\nCOUNT 1 1 1\n") +
         "WIDTH " + count + "\nHEIGHT 1\nVIEWPOINT 0 0 0 1 0 0 0\nPOINTS " + count + "\nDATA binary\n";
}

}  // namespace

Result<void> write_pcd(const std::filesystem::path& file, std::span<const Point> cloud,
                       std::span<const float> intensity) {
  assert(intensity.empty() || intensity.size() == cloud.size());
  std::vector<float> values;
  values.reserve(cloud.size() * (intensity.empty() ? 3 : 4));
  for (std::size_t i = 0; i < cloud.size(); ++i) {
    values.insert(values.end(), cloud[i].begin(), cloud[i].end());
    if (!intensity.empty()) {
      values.push_back(intensity[i]);
    }
  }
  errno = 0;
  std::ofstream out(file, std::ios::binary | std::ios::trunc);
  if (!out) {
    return Error{file.string() + ": cannot be created: " + std::strerror(errno)};
  }
  const std::string head = header(cloud.size(), !intensity.empty());
  const auto bytes = std::as_bytes(std::span(values));
  out.write(head.data(), static_cast<std::streamsize>(head.size()));
  out.write(reinterpret_cast<const char*>(bytes.data()), static_cast<std::streamsize>(bytes.size()));
  out.close();
  if (!out) {
    return Error{file.string() + ": cannot be written: " + std::strerror(errno)};
  }
  return {};
}

}  // namespace hulltrack
