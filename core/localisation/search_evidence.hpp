// What the search of the berth says for or against a pose.
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <optional>

namespace hulltrack {

/// What the search of the berth says; of interest while a pose does not follow from an earlier one.
struct SearchEvidence {
  std::size_t tried = 0;  // starts since the search began
  std::size_t starts = 0;
  std::optional<Eigen::Vector3d> rival;  // where the hull might lie as well: displacement, m
};

}  // namespace hulltrack
