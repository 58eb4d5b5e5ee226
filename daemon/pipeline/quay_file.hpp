// The quay's map from its file, and whether it can be a witness: `[quay] map`.
//
// Not judged as a hull. Failure: Error with one line that names the file. Cost: as long as the file takes to
// read, and 5 us a plane. Thread rule: pure but for the file.
#pragma once

#include <filesystem>
#include <memory>
#include <string>

#include "core/base/result.hpp"
#include "core/quay/quay_map.hpp"

namespace hulltrack {

struct QuayFile {
  Cloud cloud_W = {};
  std::shared_ptr<const QuayMap> map = {};  // of it; nullptr = no file is named
  std::string remark = {};                  // what such a map cannot tell; empty = nothing
};

/// An empty name is no file, and no error.
[[nodiscard]] Result<QuayFile> read_quay_file(const std::filesystem::path& file);

}  // namespace hulltrack
