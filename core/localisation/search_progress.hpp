// What the search of the berth says for or against a pose.
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <cstdint>
#include <optional>

namespace hulltrack {

/// Of interest while a pose does not follow from an earlier one.
struct SearchProgress {
  std::size_t tried = 0;  // starts that have been aligned, of `starts`
  std::size_t starts = 0;
  std::optional<Eigen::Vector3d> rival;  // displacement at another place that explains the scan, m
  std::uint64_t number = 0;              // of the search: Track::searches when it was wanted
};

}  // namespace hulltrack
