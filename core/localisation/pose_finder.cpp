#include "core/localisation/pose_finder.hpp"

#include <algorithm>
#include <cmath>

namespace hulltrack {
namespace {

// Approaches and scores use this many points of the thinned scan. With 500 points the share that a pose
// explains has a sigma of 2 %.
constexpr std::size_t kFew = 500;
// A scan is sparse if thinning leaves fewer points than this (a dense sensor leaves some 7,000): the fit then
// uses up to kMostOfSparse unthinned points. It needs them, and the other steps are quick then.
constexpr std::size_t kSparse = 5000;
constexpr std::size_t kMostOfSparse = 8000;
// A scan with fewer points than this on and around the hull is not used to search.
constexpr std::size_t kFewestForSearch = 100;
// All 13 starts of a search take four frames, less than health needs to return.
constexpr std::size_t kStartsAFrame = 4;
// A place is examined as closely as the pose if its score is at least this share of the pose's. A ship slid
// along the quay keeps 90 % of her points on decks and sides, so nearly every such place is examined.
constexpr double kRivals = 0.85;
// A challenger's score is more than this many times the pose's. 5 % are five sigma of the difference of two
// shares of the same points.
constexpr double kClearlyBetter = 1.05;
// Poses less than this apart may come of two alignments at one place: they are no rivals.
constexpr double kOtherPlace = 1.0;  // m
// The search begins anew if, this many frames after all starts were tried, no pose is unique: the hull may
// have moved on.
constexpr int kFramesUntilSearchedAgain = 10;
// The search reaches at most this far along X to either side of where the hull was last unique, m.
constexpr double kFarthestUnseen = 60.0;

// Turns the scan before it is thinned, so that voxels stand on their corners. With level faces, noise would
// put a few returns of a deck just below a face into voxels above it, and each of these would keep one: an
// error of 5 mm and 0.05 deg that comes and goes with the tide. Askew, every voxel is cut at a slant, and
// noise moves as many points up as down.
const Eigen::Matrix3f kAskew =
    Eigen::Quaternionf::FromTwoVectors(Point::UnitZ(), Point(1.0F, 1.0F, 1.0F)).toRotationMatrix();

// PlaneCovariance::shared: how much more clusters of residuals scatter than single ones would. Its mean
// before the first frame, and the weight of a frame's own figure (a dozen per cent off) in the mean.
constexpr double kSharedAtFirst = 2.0;
constexpr double kSharedGain = 0.1;

// Added to every axis' sigma, in quadrature, for errors that all residuals of a scan share and so cannot
// show: a beam that falls at a slant, or on an edge, is returned by its nearer part. A fortieth of a return's
// noise of 2 cm, and a turn by that between the ends of the view, 20 m apart.
constexpr double kCommonShift = 0.0005;              // m
constexpr double kCommonTurn = kCommonShift / 20.0;  // rad

}  // namespace

PoseFinder::PoseFinder(const HullConfig& hull, const RegistrationConfig& registration, const HullMap& map)
    : hull_(hull),
      registration_(registration),
      map_(&map),
      voxel_filter_(registration.voxel_size),
      point_icp_({registration.max_correspondence_distance, registration.max_iterations,
                  registration.translation_epsilon, registration.rotation_epsilon}),
      bend_shape_{hull.reference_point.x(), map.length()},
      plane_icp_({.max_iterations = registration.max_iterations}, bend_shape_),
      search_(hull.reference_point, map),
      bend_(map.length()),
      shared_{kSharedAtFirst, kSharedAtFirst} {}

void PoseFinder::thin(const Cloud& hull_W) {
  if (registration_.method == RegistrationMethod::point_to_point) {
    voxel_filter_.filter(hull_W, thinned_W_);
  } else {
    askew_.clear();
    for (const Point& p : hull_W) {
      askew_.push_back(kAskew * p);
    }
    thinned_W_.clear();
    for (const std::uint32_t i : voxel_filter_.select(askew_)) {
      thinned_W_.push_back(hull_W[i]);
    }
  }
  take_evenly(thinned_W_, kFew, few_W_);
  is_sparse_ = registration_.method == RegistrationMethod::automatic && thinned_W_.size() < kSparse;
  if (is_sparse_) {
    take_evenly(hull_W, kMostOfSparse, thinned_W_);
  }
}

PlaneIcpResult PoseFinder::find(const Cloud& hull_W, MeasurementTime time, const Track& track) {
  thin(hull_W);
  const bool in_vain = !track.unique && frames_searched_ >= kFramesUntilSearchedAgain;
  if (track.searches != searches_ || in_vain) {
    searches_ = track.searches;
    search_is_stale_ = true;
    challenger_.reset();
  }
  if (few_W_.size() < kFewestForSearch) {
    search_is_stale_ = true;
  } else if (!track.unique) {
    if (search_is_stale_) {
      begin_search(time, track);
    }
    search_.advance(few_W_, kStartsAFrame, plane_icp_);
    frames_searched_ += search_.complete() ? 1 : 0;
  }
  // The published method: each frame starts from the PLC's pose alone (Guo 2025, 2.2).
  if (registration_.method == RegistrationMethod::point_to_point) {
    PlaneIcpResult published;
    published.icp = point_icp_.align(thinned_W_, map_->tree(), Pose::Identity());
    return published;
  }
  return plane_icp_.align(thinned_W_, map_->planes(), best_start(time, track), bend_.now());
}

void PoseFinder::learn(MeasurementTime time, const PlaneIcpResult& found) {
  if (!found.icp.converged || !found.covariance.valid) {
    return;
  }
  shared_[is_sparse_] += kSharedGain * (found.covariance.shared - shared_[is_sparse_]);
  if (found.covariance.bend_sigma > 0.0) {
    bend_.update(time, found.bend + found.covariance.bend_off, found.covariance.bend_sigma);
  }
}

Matrix6 PoseFinder::covariance(const PlaneCovariance& fit) const {
  const double sigma = bend_.now().sigma;
  Twist common;
  common << Eigen::Vector3d::Constant(kCommonTurn), Eigen::Vector3d::Constant(kCommonShift);
  Matrix6 covariance =
      std::max(1.0, shared_[is_sparse_]) * fit.pose + sigma * sigma * fit.by_bend * fit.by_bend.transpose();
  covariance.diagonal() += common.cwiseAbs2();
  return covariance;
}

Pose PoseFinder::followed(MeasurementTime time, const Track& track) const {
  const FollowedPose& last = *track.followed;
  const HullSpeed speed = track.speed_record.speed().value_or(HullSpeed{});
  const double dt = std::max(0.0, to_seconds(time - last.time));
  const Eigen::Vector3d rpy = last.pose.rpy() + dt * speed.rpy_rate;
  return pose_about(hull_.reference_point, rotation_from_rpy(rpy),
                    last.pose.displacement() + dt * speed.velocity)
      .inverse();
}

Pose PoseFinder::best_start(MeasurementTime time, const Track& track) {
  Pose best = Pose::Identity();
  double best_score = -1.0;
  const auto offer = [&](const Pose& T_H_W, double margin) {
    const double score = search_.score(few_W_, T_H_W, plane_icp_);
    if (score > margin * best_score) {
      best = T_H_W;
      best_score = score;
    }
  };
  if (track.followed) {
    offer(followed(time, track), 1.0);
    const HullPose& last = track.followed->pose;
    offer(pose_about(hull_.reference_point, last.rotation(), last.displacement()).inverse(), 1.0);
  }
  offer(Pose::Identity(), 1.0);
  if (challenger_) {
    const double others = best_score;
    offer(*challenger_, kClearlyBetter);
    if (best_score == others) {
      challenger_.reset();
    }
  }
  if (!track.unique) {
    for (const HullSearch::Place& place : search_.places()) {
      if (!place.contradicted) {
        offer(place.T_H_W, 1.0);
      }
    }
  }
  return best;
}

SearchProgress PoseFinder::search(const Track& track, const std::optional<Answer>& answer,
                                  const std::function<bool(const Pose&)>& contradicts) {
  if (!answer) {
    return progress(Pose::Identity());
  }
  settle(track, answer->T_H_W, answer->T_H_W, answer->contradicted);
  if (const auto place = answer->contradicted ? std::nullopt : rival(track, answer->T_H_W)) {
    const Pose T_H_W = plane_icp_.align(thinned_W_, map_->planes(), *place, bend_.now()).icp.T_target_source;
    settle(track, *place, T_H_W, contradicts(T_H_W));
  }
  return progress(answer->T_H_W);
}

/// The place to examine beside T_H_W, if there is one.
std::optional<Pose> PoseFinder::rival(const Track& track, const Pose& T_H_W) {
  if (few_W_.size() < kFewestForSearch) {
    return std::nullopt;
  }
  if (track.unique && challenger_) {
    challenger_ = T_H_W;  // it was this frame's best start: go on from the pose found there
    return std::nullopt;
  }
  if (track.unique) {
    challenger_ = search_.challenge(few_W_, T_H_W, kClearlyBetter, plane_icp_);
    return challenger_;
  }
  const double least = kRivals * search_.score(few_W_, T_H_W, plane_icp_);
  for (const HullSearch::Place& place : search_.places()) {
    if (place.score < least) {
      break;
    }
    if (!place.contradicted && !place.explains && search_.distance(place.T_H_W, T_H_W) > kOtherPlace) {
      return place.T_H_W;
    }
  }
  return std::nullopt;
}

/// Notes how the examination of a pose ended: aligning from `start` led to T_H_W. While the pose is unique
/// this only drops a challenger that the scan contradicts.
void PoseFinder::settle(const Track& track, const Pose& start, const Pose& T_H_W, bool contradicted) {
  if (!track.unique) {
    search_.settle(start, T_H_W, contradicted);
  } else if (contradicted) {
    challenger_.reset();  // it explains more points, but its examination spoke against it
  }
}

/// How far the search has come, and the first place that rivals T_H_W.
SearchProgress PoseFinder::progress(const Pose& T_H_W) const {
  SearchProgress progress{search_.tried(), search_.starts(), std::nullopt, searches_};
  if (search_is_stale_) {
    progress = {0, 1, std::nullopt, searches_};
  }
  const Eigen::Vector3d& reference = hull_.reference_point;
  for (const HullSearch::Place& place : search_.places()) {
    if (place.explains && search_.distance(place.T_H_W, T_H_W) > kOtherPlace) {
      progress.rival = place.T_H_W.inverse() * reference - reference;
      break;
    }
  }
  return progress;
}

void PoseFinder::begin_search(MeasurementTime time, const Track& track) {
  search_is_stale_ = false;
  frames_searched_ = 0;
  Box reach = hull_.envelope;
  Eigen::Matrix3d rotation = Eigen::Matrix3d::Identity();
  if (track.last_unique) {
    const HullPose& seen = track.last_unique->pose;
    const double unseen = std::max(0.0, to_seconds(time - track.last_unique->time));
    const double far = std::min(kFarthestUnseen, kFastestHull * unseen + kUnseen);
    reach.min.x() = std::min(reach.min.x(), static_cast<float>(seen.displacement().x() - far));
    reach.max.x() = std::max(reach.max.x(), static_cast<float>(seen.displacement().x() + far));
    rotation = seen.rotation();
  }
  search_.begin(few_W_, reach, rotation);
}

}  // namespace hulltrack
