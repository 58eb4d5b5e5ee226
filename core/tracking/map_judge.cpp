#include "core/tracking/map_judge.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <utility>

#include "core/base/text.hpp"
#include "core/geometry/health_contract.hpp"
#include "core/registration/plane_covariance.hpp"
#include "core/registration/plane_system.hpp"

namespace hulltrack {
namespace {

constexpr double kPosition = HealthContract::kPosition;
constexpr double kAttitude = HealthContract::kAttitude;

// The longest ship ever built was 458 m long. A longer map is in another unit, or holds more than a ship.
constexpr double kLongestHull = 500.0;  // m
// Length of the smallest vessel that a loader serves. A shorter map may be part of one, or in another unit.
constexpr double kShortestHull = 20.0;  // m
// Least ratio of a map's length along X to its width along Y. The widest hulls, pontoons, are half as wide as
// long. A map below this ratio has its axes turned, or is a piece of a ship.
constexpr double kLeastSlender = 1.25;

// Largest distance of the reference point from the nearest map point: 0.05 m / 0.1 deg = 28.6 m. There the
// attitude error that the contract allows moves the hull by as much as the position error that it allows.
const double kFarthestReference = kPosition / kAttitude;

// Turning moves a map point by at most this share of its distance from the reference point: a hull heels by
// at most 6 deg, trims by 2 deg and yaws by 6 deg against her map (hull_search.cpp), some 9 deg together.
constexpr double kMostTurned = 0.16;

// Confirmed surfels that a healthy frame needs (integrity_limits.cpp).
constexpr std::size_t kFewestSurfaces = 40;

// Spacing of a square grid of map points that has eight of them within r: sqrt(pi r^2 / 8). A surface needs
// eight points within 0.3 m (surfels.cpp), the top of a coaming eight within 0.12 m. For messages only.
constexpr double kSurfaceSpacing = 0.19;  // m
constexpr double kRimSpacing = 0.075;     // m

constexpr std::array<const char*, 3> kAxes{"X", "Y", "Z"};

using Findings = std::vector<MapFinding>;

Findings& refuse(Findings& findings, const char* key, std::string message) {
  findings.push_back({true, key, std::move(message)});
  return findings;
}

Findings& warn(Findings& findings, const char* key, std::string message) {
  findings.push_back({false, key, std::move(message)});
  return findings;
}

/// "; in centimetres it would be 91 m" if the length would be a ship's in that unit; else empty.
std::string as_another_unit(double length) {
  for (const auto& [name, size] : {std::pair{"centimetres", 0.01}, {"millimetres", 0.001}}) {
    if (length * size >= kShortestHull && length * size <= kLongestHull) {
      return format_text("; in %s it would be %.0f m", name, length * size);
    }
  }
  return {};
}

void judge_size(const Box& box, Findings& findings) {
  const Eigen::Vector3d size = (box.max - box.min).cast<double>();
  Eigen::Index longest = 0;
  const double length = size.maxCoeff(&longest);
  if (length > kLongestHull) {
    refuse(
        findings, "hull.map",
        format_text(
            "extends %.0f m along %s, and no hull is longer than %.0f m%s; save the map in metres, with "
            "nothing in it but the ship",
            length, kAxes[static_cast<std::size_t>(longest)], kLongestHull, as_another_unit(length).c_str()));
  } else if (length < kShortestHull) {
    warn(findings, "hull.map",
         format_text(
             "extends %.2f m, and the smallest hull at a loader is %.0f m long; is it in metres, and is all "
             "of the ship in it?",
             length, kShortestHull));
  } else if (size.x() < kLeastSlender * size.y()) {
    warn(
        findings, "hull.map",
        format_text(
            "extends %.1f m along X and %.1f m along Y, and a hull is longer than wide; does X run along the "
            "quay, and is all of the ship in it?",
            size.x(), size.y()));
  }
}

void judge_reference(const Cloud& cloud_H, const Eigen::Vector3d& reference, Findings& findings) {
  double nearest2 = std::numeric_limits<double>::infinity();
  for (const Point& p : cloud_H) {
    nearest2 = std::min(nearest2, (p.cast<double>() - reference).squaredNorm());
  }
  const double distance = std::sqrt(nearest2);
  if (distance > kFarthestReference) {
    refuse(findings, "hull.reference_point",
           format_text(
               "lies %.1f m from the nearest point of the map: 0.1 deg, the error that an attitude may have, "
               "moves the hull by %.2f m against it, more than the 0.05 m of a position; choose a point of "
               "the map, at most %.1f m from it",
               distance, distance * kAttitude, kFarthestReference));
  }
}

void judge_envelope(const Box& envelope, Findings& findings) {
  for (int axis = 0; axis < 3; ++axis) {
    const double side = static_cast<double>(envelope.max[axis]) - static_cast<double>(envelope.min[axis]);
    if (side < 2.0 * kPosition) {
      refuse(findings, "hull.envelope",
             format_text(
                 "is %.3f m wide along %s, and a position is known to 0.05 m either way: no pose would stay "
                 "in it; give the displacements that tide, draft and moorings allow, %.1f m or more",
                 side, kAxes[static_cast<std::size_t>(axis)], 2.0 * kPosition));
    }
  }
  if (!envelope.contains(Point::Zero())) {
    warn(findings, "hull.envelope",
         "leaves out 0, 0, 0, where the ship lay when she was mapped; right only if she can never lie so "
         "again");
  }
}

/// How far a box is from another along each axis, m; zero where they overlap.
Eigen::Vector3d gap(const Box& a, const Box& b) {
  const Point low = (a.min - b.max).cwiseMax(b.min - a.max);
  return low.cwiseMax(Point::Zero()).cast<double>();
}

void judge_region(const Cloud& cloud_H, const HullConfig& hull, Findings& findings) {
  const Box& region = *hull.region;
  bool any_now = false;
  double nearest = std::numeric_limits<double>::infinity();
  for (const Point& p : cloud_H) {
    any_now = any_now || region.contains(p);
    const auto turned = static_cast<float>(kMostTurned * (p.cast<double>() - hull.reference_point).norm());
    const Box reach{p + hull.envelope.min - Point::Constant(turned),
                    p + hull.envelope.max + Point::Constant(turned)};
    nearest = std::min(nearest, gap(reach, region).norm());
  }
  if (nearest > 0.0) {
    refuse(
        findings, "hull.region",
        format_text(
            "no point of the map can come nearer to it than %.1f m, wherever in hull.envelope the ship lies: "
            "all of her would be left out; give the box in the world that she lies in, or [] for none",
            nearest));
  } else if (!any_now) {
    warn(findings, "hull.region",
         "holds no point of the map as it lies, only of a ship that has moved; is it given in the world's "
         "frame?");
  }
}

/// Median distance from at most kSamples map points to their nearest neighbours, m.
double spacing_of(const HullMap& map) {
  constexpr std::size_t kSamples = 999;
  const Cloud& cloud = map.cloud_H();
  std::vector<double> distances;
  std::vector<Neighbour> near;
  for (std::size_t i = 0; i < cloud.size(); i += cloud.size() / kSamples + 1) {
    map.tree().nearest_k(cloud[i], 2, std::numeric_limits<float>::infinity(), near);
    distances.push_back(std::sqrt(static_cast<double>(near.back().squared_distance)));
  }
  const auto middle = distances.begin() + static_cast<std::ptrdiff_t>(distances.size() / 2);
  std::nth_element(distances.begin(), middle, distances.end());
  return *middle;
}

/// How many of the six directions of a pose stay free even if every flat piece of the map is seen once.
int free_directions(const std::vector<PlaneMap::Plane>& planes) {
  Eigen::Vector3d middle = Eigen::Vector3d::Zero();
  for (const PlaneMap::Plane& plane : planes) {
    middle += plane.centre_H.cast<double>() / static_cast<double>(planes.size());
  }
  PlaneSystem system(middle, 1.0);
  for (const PlaneMap::Plane& plane : planes) {
    system.add(plane.centre_H.cast<double>(), plane.normal_H.cast<double>(), 0.0);
  }
  return system.solve().free;
}

void judge_surfaces(const HullMap& map, Findings& findings) {
  const auto& surfels = map.surfels();
  const auto fixed = static_cast<std::size_t>(std::count_if(
      surfels.begin(), surfels.end(), [](const Surfel& surfel) { return surfel.planar && !surfel.movable; }));
  const auto& planes = map.planes().planes();
  std::array<std::size_t, kSurfaceClasses + 1> facing{};
  for (const PlaneMap::Plane& plane : planes) {
    ++facing[static_cast<std::size_t>(plane.surface)];
  }
  if (fixed < kFewestSurfaces) {
    warn(
        findings, "hull.map",
        format_text(
            "only %zu of its %zu surfaces are flat and fixed, and health needs %zu in view: it will not "
            "come; "
            "the points are %.2f m apart (a surface needs %.2f m or less, with noise below 2 cm): make a map "
            "of the hull with 5 cm voxels",
            fixed, surfels.size(), kFewestSurfaces, spacing_of(map), kSurfaceSpacing));
  } else if (const int free = free_directions(planes);
             free > 0 || map.planes().clusters() < PlaneCovarianceEstimator::kFewestClusters) {
    warn(findings, "hull.map",
         format_text(
             "its surfaces leave %d of the six directions of a pose free (%zu flat pieces face along X, %zu "
             "along Y, %zu along Z, %zu aslant, in %u places, where %zu are needed): health will not come; "
             "map "
             "more of the hull, hatches above all",
             free, facing[0], facing[1], facing[2], facing[3], map.planes().clusters(),
             PlaneCovarianceEstimator::kFewestClusters));
  }
}

void judge_rims(const HullMap& map, Findings& findings) {
  const auto& rims = map.rims();
  if (std::none_of(rims.begin(), rims.end(), [](const RimPoint& rim) { return rim.is_measured(); })) {
    warn(
        findings, "hull.map",
        format_text(
            "no coaming's top was found in it, so that little tells this ship from her sisters; map her with "
            "a hatch open and points %.3f m apart or less (they are %.3f m)",
            kRimSpacing, spacing_of(map)));
  }
}

}  // namespace

std::vector<MapFinding> judge_cloud(const Cloud& cloud_H, const TrackerConfig& config) {
  Findings findings;
  const auto fewest = static_cast<std::size_t>(config.health.min_matched);
  if (cloud_H.size() < fewest) {
    refuse(findings, "hull.map",
           "has " + counted(cloud_H.size(), "point") + ", fewer than health.min_matched = " +
               std::to_string(fewest) + "; no scan could ever match it: make a denser map");
  }
  judge_size(bounding_box(cloud_H), findings);
  judge_reference(cloud_H, config.hull.reference_point, findings);
  judge_envelope(config.hull.envelope, findings);
  if (config.hull.region) {
    judge_region(cloud_H, config.hull, findings);
  }
  return findings;
}

std::vector<MapFinding> judge_map(const HullMap& map) {
  Findings findings;
  if (map.subset_H().size() < kFewestSurfaces) {
    refuse(
        findings, "hull.map",
        format_text(
            "all of its %zu points lie in %zu cubes of %.1f m, and %zu are the fewest that a pose could be "
            "judged by; make a map of the hull, in metres",
            map.cloud_H().size(), map.subset_H().size(), static_cast<double>(HullMap::kSubsetVoxel),
            kFewestSurfaces));
    return findings;
  }
  judge_surfaces(map, findings);
  if (findings.empty()) {
    judge_rims(map, findings);
  }
  return findings;
}

bool is_refused(const std::vector<MapFinding>& findings) {
  return std::any_of(findings.begin(), findings.end(),
                     [](const MapFinding& finding) { return finding.refused; });
}

}  // namespace hulltrack
