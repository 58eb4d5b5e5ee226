#include "core/integrity/pose_observations.hpp"

#include <algorithm>
#include <cmath>

#include "core/map/surfels.hpp"

namespace hulltrack {
namespace {

using pose_observations::kBehind;
using pose_observations::kPlaneGate;
using surface_rays::kGrazing;
using surface_rays::kSameSurface;

constexpr float kHidden = 0.1F;     // m: a return farther before a surfel may be of another mapped surface
constexpr float kStepGate = 0.5F;   // m: a return farther off the plane is of something else
constexpr float kOnRim = 0.1F;      // m across from a rim point: nearer is surely coaming
constexpr float kAlongRim = 0.1F;   // m along from a rim point: half of the distance of rim points
constexpr float kBelowRim = 0.15F;  // m: a return lower below a rim's top went down beside it
constexpr float kRaised = 0.03F;    // m: a surface higher above a rim may be a cover

/// Axes at a rim point in L: n upward, across its rim towards the hold.
struct RimAxes {
  Point p_L, n_L, across_L;

  [[nodiscard]] float across(const Point& q_L) const { return across_L.dot(q_L - p_L); }
  [[nodiscard]] bool is_beside_rim(const Point& q_L) const {
    return std::abs(n_L.cross(across_L).dot(q_L - p_L)) < kAlongRim;
  }
  [[nodiscard]] bool is_on_rim(const Point& q_L) const {
    return is_beside_rim(q_L) && std::abs(across(q_L)) < kOnRim;
  }
};

/// Calls visit(return, where its ray meets the level plane of the top, the return's height over that plane)
/// for the rays around a rim point.
template <typename Visit>
void look_across(const ScanView& view, const RimAxes& axes, Visit&& visit) {
  const float plane = axes.n_L.dot(axes.p_L);
  view.visit_around(SphericalGrid::cell(axes.p_L), [&](const Point& ray) {
    const float down = axes.n_L.dot(ray);
    if (std::abs(down) > kGrazing * ray.norm()) {
      visit(ray, Point(plane / down * ray), down - plane);
    }
  });
}

/// Does the map have another surface close before a surfel, towards the sensor? Visibility has a tolerance
/// and does not notice: a deck hides the ship's side just below its edge, for example.
bool is_behind_another(const HullMap& map, const Surfel& surfel, const Point& sensor_H) {
  const Point to_sensor = (sensor_H - surfel.centre_H).normalized();
  // The first step is at 2 kHidden, because nearer map points may be of the surfel's own surface.
  for (int step = 2; static_cast<float>(step) * kHidden < kBehind + kHidden / 2.0F; ++step) {
    const Point before = surfel.centre_H + static_cast<float>(step) * kHidden * to_sensor;
    const auto near = map.tree().nearest(before, kHidden);
    if (near && std::abs(surfel.normal_H.dot(map.cloud_H()[near->index] - surfel.centre_H)) > kSameSurface) {
      return true;
    }
  }
  return false;
}

/// Asks the rays of one scan about one pose.
class Observer {
 public:
  Observer(const HullMap& map, const Pose& T_W_H) : map_(map), T_W_H_(T_W_H) {}
  void observe_surfel(const VisiblePoint& point, const ScanView& view);
  void observe_rim(const RimPoint& rim, const VisiblePoint& point, const ScanView& view);
  [[nodiscard]] PoseObservations take() { return std::move(seen_); }

 private:
  const HullMap& map_;
  const Pose& T_W_H_;
  PoseObservations seen_;
  std::vector<RayEnd> rays_;  // scratch
};

void Observer::observe_surfel(const VisiblePoint& point, const ScanView& view) {
  const Surfel& surfel = map_.surfels()[point.index];
  if (!surfel.planar || surfel.movable) {
    return;
  }
  const Eigen::Vector3d n_W = T_W_H_.linear() * surfel.normal_H.cast<double>();
  const Point n_L = (view.T_W_L().linear().transpose() * n_W).cast<float>();
  if (surfel.backed && n_L.dot(point.p_L) > 0.0F) {
    return;  // the sensor is on its other side, where another surface hides it
  }
  collect_rays(view, point.p_L, n_L, rays_);
  const RayEnd* nearest = nearest_ray(rays_);
  if (nearest == nullptr) {
    return;
  }
  if (nearest->depth < -kHidden &&
      is_behind_another(map_, surfel, (T_W_H_.inverse() * view.T_W_L().translation()).cast<float>())) {
    return;
  }
  const bool confirmed = std::abs(nearest->offset) <= kPlaneGate;
  const bool through = !confirmed && nearest->depth > kBehind;
  SurfelCounts& counts = seen_.counts;
  ++counts.expected;
  counts.confirmed += confirmed ? 1 : 0;
  counts.seen_through += through ? 1 : 0;
  if (surfel.surface != SurfaceClass::other) {
    SurfaceCount& count = counts.surfaces[static_cast<std::size_t>(surfel.surface)];
    ++count.expected;
    count.confirmed += confirmed ? 1 : 0;
  }
  if (std::abs(nearest->offset) <= kStepGate) {
    const Eigen::Vector3d p_W = T_W_H_ * map_.subset_H()[point.index].cast<double>();
    const auto [offset, weight] = mean_offset(rays_, *nearest);
    seen_.surfels.push_back({p_W, n_W, offset, weight});
    if (surfel.landmark != Surfel::kNoLandmark) {
      seen_.landmarks.push_back({surfel.landmark, seen_.surfels.back(), LandmarkObservation::on});
    }
  } else if (surfel.landmark != Surfel::kNoLandmark && through) {
    seen_.landmarks.push_back({surfel.landmark, {.n_W = n_W}, LandmarkObservation::through});
  }
}

void Observer::observe_rim(const RimPoint& rim, const VisiblePoint& point, const ScanView& view) {
  if (rim.landmark == Surfel::kNoLandmark) {
    return;
  }
  // The top is taken to be level: of so small a disc the height is known better than the slope.
  const Eigen::Vector3d n_W = T_W_H_.linear() * Eigen::Vector3d::UnitZ();
  const Eigen::Vector3d p_W = T_W_H_ * rim.p_H.cast<double>();
  const Pose T_L_W = view.T_W_L().inverse();
  const Point n_L = (T_L_W.linear() * n_W).cast<float>();
  float raised = 0.0F;
  const RimAxes axes{point.p_L, n_L, (T_L_W.linear() * T_W_H_.linear()).cast<float>() * rim.across_H};
  const auto on = [&](float offset) {
    seen_.landmarks.push_back(
        {rim.landmark, {p_W, n_W, static_cast<double>(offset), 1.0}, LandmarkObservation::on});
    raised = std::max(raised, offset);
  };
  look_across(view, axes, [&](const Point& returned, const Point& met, float offset) {
    // The return itself has to be over the rim, not just where its ray meets the plane: the side of a cover
    // that stands on the rim gives returns of all heights.
    if (std::abs(offset) <= kStepGate && axes.is_on_rim(returned)) {
      on(offset);
    } else if (offset < -kStepGate && axes.is_on_rim(met)) {
      seen_.landmarks.push_back({rim.landmark, {.n_W = n_W}, LandmarkObservation::through});
    }
    const bool through = offset < -kBelowRim;
    const Point& where = through ? met : returned;
    if (rim.is_measured() && offset < kBelowRim && axes.is_beside_rim(where)) {
      seen_.rim_rays.push_back({&rim, axes.across(where), offset, through});
    }
  });
  if (raised < kRaised) {
    return;
  }
  const Eigen::Vector3d over_hold_W = T_W_H_ * rim.over_hold_H.cast<double>();
  collect_rays(view, (T_L_W * over_hold_W).cast<float>() + raised * n_L, n_L, rays_);
  if (const RayEnd* beside = nearest_ray(rays_)) {
    const bool goes_on = std::abs(beside->offset) < kSameSurface;
    seen_.landmarks.push_back(
        {rim.landmark, {}, goes_on ? LandmarkObservation::goes_on : LandmarkObservation::ends});
  }
}

}  // namespace

PoseObservations observe_pose(const HullMap& map, std::span<const VisiblePoint> visible, const Pose& T_W_H,
                              std::span<const ScanView> views) {
  Observer observer(map, T_W_H);
  const std::size_t surfels = map.surfels().size();
  for (const VisiblePoint& point : visible) {
    if (point.index < surfels) {
      observer.observe_surfel(point, views[point.lidar]);
    } else {
      observer.observe_rim(map.rims()[point.index - surfels], point, views[point.lidar]);
    }
  }
  return observer.take();
}

}  // namespace hulltrack
