// A simulation as a recording folder: lidar.pcap, plc.csv, hull.pcd, quay.pcd, hulltrackd.toml; of the truth,
// truth.csv and returns.csv: how many returns from beyond a metre the LiDARs had in each frame, at its
// middle.
//
// Files are written under temporary names and renamed when all are complete, so that an interrupted run
// leaves nothing that looks whole. The same simulation gives the same bytes. All cores work.
// Failure: one line with file and reason (disk full, no permission, folder not empty).
#pragma once

#include <filesystem>
#include <functional>
#include <vector>

#include "core/base/result.hpp"
#include "core/io/plc_csv.hpp"
#include "daemon/simulator/run/simulated_berth.hpp"

namespace hulltrack {

/// Told the share of datagrams done, [0, 1]; false stops the job.
using ProgressCallback = std::function<bool(double share)>;

/// `folder` is made if need be; one that holds anything is refused unless `overwrite`.
[[nodiscard]] Result<void> write_recording(const SimulatedBerth& berth, const std::filesystem::path& folder,
                                           bool overwrite, const ProgressCallback& progress);

/// Only hull.pcd, quay.pcd and hulltrackd.toml, for a service that listens to a live simulation.
[[nodiscard]] Result<void> write_site_files(const SimulatedBerth& berth, const std::filesystem::path& folder,
                                            bool overwrite, const std::string& config_text);

/// What a recorder that polls every 20 ms wrote down, from half a second before the first frame to half a
/// second after the last.
[[nodiscard]] std::vector<PlcCsvRow> recorded_plc(const SimulatedBerth& berth);

/// The hull's pose every 10 ms over the same time: every frame's middle is a row.
[[nodiscard]] std::vector<TruthRow> recorded_truth(const SimulatedBerth& berth);

}  // namespace hulltrack
