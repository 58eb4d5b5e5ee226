// Everything that the service needs from files, read and checked before any of it is used.
//
// The work of the reader (reader.hpp), a process of its own: what a damaged file does to it, it does not do
// to the service. The map is made here as well, for proof that this ends within the reader's limits.
// Cost: as long as the map takes to read and to make. Failure: problems; throws only when memory runs out
// elsewhere than at a file. Thread rule: pure but for the files that it reads.
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>

#include "daemon/config/read_config.hpp"
#include "daemon/service/prepared_files.hpp"

namespace hulltrack {

/// What is under way while files are made ready.
enum class PreparationStep : std::uint8_t {
  configuration,       // being read
  configuration_read,  // its bytes have been handed over
  calibration,         // being read
  quay,                // being read, and what the tracker needs of it being made
  map,                 // being read
  map_making,          // what the tracker needs of it
  done,
};

/// Told each step as it begins; `lidar` counts from 0 with PreparationStep::calibration.
using OnPreparationStep = std::function<void(PreparationStep step, std::size_t lidar)>;

/// The calibrations and the map that a configuration names, read and judged. Goes on where the configuration
/// has problems, so that a person hears of all of them at once. `memory_mb`: what is allowed, for messages.
[[nodiscard]] PreparedFiles read_prepared_files(const std::filesystem::path& config_file,
                                                const ConfigReading& reading, std::size_t memory_mb,
                                                const OnPreparationStep& begins);

}  // namespace hulltrack
