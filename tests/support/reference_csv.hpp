// Reference clouds of real captures: what another decoder made of the same packets, as csv.gz.
//
// They live outside the repository (HULLTRACK_SHARED_DIR); tests skip where they are absent.
#pragma once

#include <array>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <string>
#include <vector>

namespace hulltrack::test {

inline std::filesystem::path reference_folder(const char* name) {
  return std::filesystem::path(HULLTRACK_SHARED_DIR) / "lidar" / name;
}

/// The rows of `file` that begin with N numbers; empty when it cannot be read.
template <std::size_t N>
std::vector<std::array<double, N>> read_csv_gz(const std::filesystem::path& file) {
  std::vector<std::array<double, N>> rows;
  if (!std::filesystem::exists(file)) return rows;
  const std::string command = "gzip -dc '" + file.string() + "'";
  std::FILE* pipe = popen(command.c_str(), "r");
  if (pipe == nullptr) return rows;
  char line[512];
  while (std::fgets(line, sizeof line, pipe) != nullptr) {
    std::array<double, N> row{};
    const char* at = line;
    bool numbers = true;
    for (double& value : row) {
      char* end = nullptr;
      value = std::strtod(at, &end);
      numbers = numbers && end != at;
      at = end + (*end == ',' ? 1 : 0);
    }
    if (numbers) rows.push_back(row);  // else the header
  }
  pclose(pipe);
  return rows;
}

}  // namespace hulltrack::test
