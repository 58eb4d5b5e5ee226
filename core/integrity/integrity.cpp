#include "core/integrity/integrity.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "core/localisation/track.hpp"
#include "core/map/surfels.hpp"
#include "core/sight/surface_rays.hpp"

namespace hulltrack {

namespace {

using surface_rays::kGrazing;
using surface_rays::kSameSurface;

constexpr float kHidden = 0.1F;     // m: a return farther before a surfel may be of another mapped surface
constexpr float kStepGate = 0.5F;   // m: a return farther off the plane is of something else
constexpr float kOnRim = 0.1F;      // m across from a rim point: nearer is surely coaming
constexpr float kAlongRim = 0.1F;   // m along from a rim point: half of the distance of rim points
constexpr float kBelowRim = 0.15F;  // m: a return lower below a rim's top went down beside it
// A direction in which the pose is less sure tells nothing of landmarks: three times this is a displaced
// landmark.
constexpr double kBlurred = 0.015;  // m, 1 sigma
constexpr float kRaised = 0.03F;    // m: a surface higher above a rim may be a cover
// After a jump farther than this the landmarks' histograms are of other surfaces: they are forgotten.
constexpr double kOtherPlace = LandmarkMemory::kReach;  // m
// A pose jumps if it moves by kJump more than kFastestHull allows: some three sigma of a pose that is as sure
// as kBlurred. At most kGap counts as time for the hull to move, two frames without landmarks and a margin.
constexpr double kJump = 0.05;  // m
constexpr double kGap = 0.25;   // s
// After a longer time without landmarks they are forgotten: another ship may have moored there.
constexpr double kExchange = 300.0;  // s

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
  for (int step = 2; static_cast<float>(step) * kHidden < Integrity::kBehind + kHidden / 2.0F; ++step) {
    const Point before = surfel.centre_H + static_cast<float>(step) * kHidden * to_sensor;
    const auto near = map.tree().nearest(before, kHidden);
    if (near && std::abs(surfel.normal_H.dot(map.cloud_H()[near->index] - surfel.centre_H)) > kSameSurface) {
      return true;
    }
  }
  return false;
}

}  // namespace

IntegrityReport Integrity::run(const HullMap& map, std::span<const VisiblePoint> visible, const Pose& T_W_H,
                               std::span<const ScanView> views) {
  IntegrityReport report;
  observations_.clear();
  of_landmarks_.clear();
  rim_rays_.clear();
  const std::size_t surfels = map.surfels().size();
  for (const VisiblePoint& point : visible) {
    if (point.index < surfels) {
      observe_surfel(map, point, T_W_H, views[point.lidar], report);
    } else {
      observe_rim(map.rims()[point.index - surfels], point, T_W_H, views[point.lidar]);
    }
  }
  return report;
}

void Integrity::weigh(const HullMap& map, MeasurementTime time, const Pose& T_W_H,
                      const Eigen::Vector3d& reference_W, const BendShape& shape, double bend,
                      IntegrityReport& report) {
  if (landmarks_.size() != map.landmarks().size()) {
    landmarks_.reset(map.landmarks());
  }
  landmarks_.begin_frame();
  if (report.step.solved && report.step.is_finite() &&
      (judge_pose_integrity(report).faults & fault::contradicted) == 0) {
    follow_pose(map, time, T_W_H, reference_W);
    const PlaneStep& step = report.step;
    observe_landmarks({T_W_H, reference_W, step.translation, step.rotation, shape, bend},
                      step.covariance_translation);
  }
  report.landmarks = landmarks_.report();
}

/// Compares the pose with that of the last observation. After a long time, or a jump that is long or follows
/// a gap, the landmarks are forgotten; after another jump it counts as seen elsewhere.
void Integrity::follow_pose(const HullMap& map, MeasurementTime time, const Pose& T_W_H,
                            const Eigen::Vector3d& reference_W) {
  if (weighed_) {
    const double dt = std::max(0.0, to_seconds(time - weighed_->time));
    const Eigen::Vector3d moved_W = reference_W - weighed_->reference_W;
    const double moved = moved_W.norm();
    const bool jumped = moved > kJump + kFastestHull * std::min(dt, kGap);
    if (dt > kExchange || (jumped && (dt > kGap || moved > kOtherPlace))) {
      landmarks_.reset(map.landmarks());
    } else if (jumped) {
      landmarks_.put_elsewhere((T_W_H.linear().transpose() * moved_W).cast<float>());
    }
  }
  weighed_ = {time, reference_W};
}

void Integrity::observe_surfel(const HullMap& map, const VisiblePoint& point, const Pose& T_W_H,
                               const ScanView& view, IntegrityReport& report) {
  const Surfel& surfel = map.surfels()[point.index];
  if (!surfel.planar || surfel.movable) {
    return;
  }
  const Eigen::Vector3d n_W = T_W_H.linear() * surfel.normal_H.cast<double>();
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
      is_behind_another(map, surfel, (T_W_H.inverse() * view.T_W_L().translation()).cast<float>())) {
    return;
  }
  const bool confirmed = std::abs(nearest->offset) <= kPlaneGate;
  const bool through = !confirmed && nearest->depth > kBehind;
  ++report.expected;
  report.confirmed += confirmed ? 1 : 0;
  report.seen_through += through ? 1 : 0;
  if (surfel.surface != SurfaceClass::other) {
    SurfaceCount& count = report.surfaces[static_cast<std::size_t>(surfel.surface)];
    ++count.expected;
    count.confirmed += confirmed ? 1 : 0;
  }
  if (std::abs(nearest->offset) <= kStepGate) {
    const Eigen::Vector3d p_W = T_W_H * map.subset_H()[point.index].cast<double>();
    const auto [offset, weight] = mean_offset(rays_, *nearest);
    observations_.push_back({p_W, n_W, offset, weight});
    if (surfel.landmark != Surfel::kNoLandmark) {
      of_landmarks_.push_back({surfel.landmark, observations_.back(), LandmarkObservation::on});
    }
  } else if (surfel.landmark != Surfel::kNoLandmark && through) {
    of_landmarks_.push_back({surfel.landmark, {.n_W = n_W}, LandmarkObservation::through});
  }
}

void Integrity::observe_rim(const RimPoint& rim, const VisiblePoint& point, const Pose& T_W_H,
                            const ScanView& view) {
  if (rim.landmark == Surfel::kNoLandmark) {
    return;
  }
  // The top is taken to be level: of so small a disc the height is known better than the slope.
  const Eigen::Vector3d n_W = T_W_H.linear() * Eigen::Vector3d::UnitZ();
  const Eigen::Vector3d p_W = T_W_H * rim.p_H.cast<double>();
  const Pose T_L_W = view.T_W_L().inverse();
  const Point n_L = (T_L_W.linear() * n_W).cast<float>();
  float raised = 0.0F;
  const RimAxes axes{point.p_L, n_L, (T_L_W.linear() * T_W_H.linear()).cast<float>() * rim.across_H};
  const auto on = [&](float offset) {
    of_landmarks_.push_back(
        {rim.landmark, {p_W, n_W, static_cast<double>(offset), 1.0}, LandmarkObservation::on});
    raised = std::max(raised, offset);
  };
  look_across(view, axes, [&](const Point& returned, const Point& met, float offset) {
    // The return itself has to be over the rim, not just where its ray meets the plane: the side of a cover
    // that stands on the rim gives returns of all heights.
    if (std::abs(offset) <= kStepGate && axes.is_on_rim(returned)) {
      on(offset);
    } else if (offset < -kStepGate && axes.is_on_rim(met)) {
      of_landmarks_.push_back({rim.landmark, {.n_W = n_W}, LandmarkObservation::through});
    }
    const bool through = offset < -kBelowRim;
    const Point& where = through ? met : returned;
    if (rim.is_measured() && offset < kBelowRim && axes.is_beside_rim(where)) {
      rim_rays_.push_back({&rim, axes.across(where), offset, through});
    }
  });
  if (raised < kRaised) {
    return;
  }
  const Eigen::Vector3d over_hold_W = T_W_H * rim.over_hold_H.cast<double>();
  collect_rays(view, (T_L_W * over_hold_W).cast<float>() + raised * n_L, n_L, rays_);
  if (const RayEnd* beside = nearest_ray(rays_)) {
    const bool goes_on = std::abs(beside->offset) < kSameSurface;
    of_landmarks_.push_back(
        {rim.landmark, {}, goes_on ? LandmarkObservation::goes_on : LandmarkObservation::ends});
  }
}

Eigen::Vector3d Integrity::Shift::at(const Eigen::Vector3d& p_W) const {
  const double x_H = T_W_H.linear().col(0).dot(p_W - T_W_H.translation());
  return translation + rotation.cross(p_W - reference_W) + bend * shape.rise(x_H) * T_W_H.linear().col(2);
}

/// Adds the frame's observations and rim rays to the landmarks, less what `shift` (pose error and bend)
/// explains.
void Integrity::observe_landmarks(const Shift& shift, const Eigen::Matrix3d& covariance_translation) {
  const Pose& T_W_H = shift.T_W_H;
  // True if the pose is sure enough along the normal for an offset to say something about the ship.
  const auto sharp = [&](const Eigen::Vector3d& n_W) {
    return n_W.dot(covariance_translation * n_W) < kBlurred * kBlurred;
  };
  const RimPoint* last = nullptr;
  bool used = false;
  float lift = 0.0F;
  float aside = 0.0F;
  for (const RimRay& ray : rim_rays_) {
    if (ray.rim != last) {
      last = ray.rim;
      const Eigen::Vector3d moved_H =
          T_W_H.linear().transpose() * shift.at(T_W_H * ray.rim->p_H.cast<double>());
      lift = static_cast<float>(moved_H.z());
      aside = ray.rim->across_H.dot(moved_H.cast<float>());
      used = sharp(T_W_H.linear() * ray.rim->across_H.cast<double>());
    }
    if (!used) {
      continue;
    }
    if (ray.through || std::abs(ray.offset - lift) < kSameSurface) {
      landmarks_.add_across(*ray.rim, ray.s - aside, !ray.through);
    }
  }
  for (const LandmarkObservation& observed : of_landmarks_) {
    switch (observed.kind) {
      case LandmarkObservation::on:
        if (!sharp(observed.seen.n_W)) {
          break;
        }
        landmarks_.add_offset(observed.landmark,
                              observed.seen.offset - observed.seen.n_W.dot(shift.at(observed.seen.p_W)),
                              observed.seen.weight);
        break;
      case LandmarkObservation::through:
        if (sharp(observed.seen.n_W)) {
          landmarks_.add_through(observed.landmark);
        }
        break;
      case LandmarkObservation::goes_on:
      case LandmarkObservation::ends:
        landmarks_.add_beside(observed.landmark, observed.kind == LandmarkObservation::goes_on);
        break;
    }
  }
}

}  // namespace hulltrack
