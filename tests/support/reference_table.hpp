// Clouds that other decoders made of real captures, as tables.
//
// Live outside the repository (HULLTRACK_SHARED_DIR); tests skip where they are absent.
#pragma once

#include <array>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <string>
#include <vector>

namespace hulltrack::test {

/// Folder of a capture, its description and what another decoder made of it.
inline std::filesystem::path capture_folder(const char* name) {
  return std::filesystem::path(HULLTRACK_SHARED_DIR) / "lidar" / name;
}

/// Rows of a gzipped CSV whose first `columns` fields are numbers; empty when it cannot be read.
template <std::size_t columns>
std::vector<std::array<double, columns>> read_reference_table(const std::filesystem::path& file) {
  std::vector<std::array<double, columns>> rows;
  if (!std::filesystem::exists(file)) return rows;
  const std::string command = "gzip -dc '" + file.string() + "'";
  std::FILE* pipe = popen(command.c_str(), "r");
  if (pipe == nullptr) return rows;
  char line[512];
  while (std::fgets(line, sizeof line, pipe) != nullptr) {
    std::array<double, columns> row{};
    const char* at = line;
    bool numbers = true;
    for (double& value : row) {
      char* end = nullptr;
      value = std::strtod(at, &end);
      numbers = numbers && end != at;
      at = end + (*end == ',' ? 1 : 0);
    }
    if (numbers) rows.push_back(row);  // otherwise the header
  }
  pclose(pipe);
  return rows;
}

}  // namespace hulltrack::test
