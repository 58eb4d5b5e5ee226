#include "core/quay/quay_observer.hpp"

#include <algorithm>
#include <cmath>

namespace hulltrack {
namespace {

/// The rarest class whose bit is set in `named`: transverse before longitudinal, other, horizontal.
constexpr SurfaceClass rarest_of(std::size_t named) {
  SurfaceClass rarest = SurfaceClass::horizontal;
  for (const SurfaceClass surface :
       {SurfaceClass::other, SurfaceClass::longitudinal, SurfaceClass::transverse}) {
    rarest = (named >> static_cast<unsigned>(surface) & 1U) != 0 ? surface : rarest;
  }
  return rarest;
}

constexpr auto kRarestOf = [] {
  std::array<SurfaceClass, std::size_t{1} << QuayMap::kClasses> rarest{};
  for (std::size_t named = 0; named < rarest.size(); ++named) {
    rarest.at(named) = rarest_of(named);
  }
  return rarest;
}();

}  // namespace

const QuayObservations& QuayObserver::observe(const QuayMap& map, const Cloud& returns_W,
                                              const OfClass& most) {
  ++frame_;
  choose(map, returns_W, most);
  nearest_.resize(chosen_W_.size());
  map.tree().nearest(chosen_W_, kGate, nearest_);
  for (std::size_t i = 0; i < chosen_W_.size(); ++i) {
    if (nearest_[i].index == Neighbour::kNone) {
      continue;
    }
    const QuayMap::Plane& plane = map.planes()[nearest_[i].index];
    if (plane.holds(chosen_W_[i], static_cast<double>(kGate))) {
      keep(plane.surface, chosen_W_[i], plane.normal_W.cast<double>(), plane.offset(chosen_W_[i]));
    }
  }
  return gather();
}

const QuayObservations& QuayObserver::observe(const QuayPlane& top, const Cloud& returns_W) {
  ++frame_;
  const Eigen::Vector3d n_W = top.normal();
  for (const Point& p : returns_W) {
    if (const double offset = top.above(p.cast<double>()); std::abs(offset) <= static_cast<double>(kGate)) {
      keep(SurfaceClass::horizontal, p, n_W, offset);
    }
  }
  return gather();
}

void QuayObserver::forget() {
  for (auto& of_class : recent_) {
    of_class.clear();
  }
}

/// Picks the returns that are compared with planes. A return that may be of several classes counts as one of
/// the rarest.
void QuayObserver::choose(const QuayMap& map, const Cloud& returns_W, const OfClass& most) {
  for (Cloud& of_class : candidates_W_) {
    of_class.clear();
  }
  // All cells are read before the first is used, so that the memory accesses overlap.
  near_.resize(returns_W.size());
  std::transform(returns_W.begin(), returns_W.end(), near_.begin(),
                 [&map](const Point& p) { return map.classes_near(p); });
  for (std::size_t i = 0; i < returns_W.size(); ++i) {
    if (near_[i] != 0) {
      candidates_W_[static_cast<std::size_t>(kRarestOf[near_[i]])].push_back(returns_W[i]);
    }
  }
  chosen_W_.clear();
  for (std::size_t surface = 0; surface < candidates_W_.size(); ++surface) {
    const Cloud& of_class = candidates_W_[surface];
    const std::size_t stride =
        std::max<std::size_t>(1, (of_class.size() + most[surface] - 1) / most[surface]);
    for (std::size_t i = frame_ % stride; i < of_class.size(); i += stride) {
      chosen_W_.push_back(of_class[i]);
    }
  }
}

void QuayObserver::keep(SurfaceClass surface, const Point& return_W, const Eigen::Vector3d& n_W,
                        double offset) {
  recent_.at(static_cast<std::size_t>(surface))
      .push_back({frame_, {return_W.cast<double>() - offset * n_W, n_W, offset, surface, 0}});
}

const QuayObservations& QuayObserver::gather() {
  observations_.all.clear();
  for (auto& of_class : recent_) {
    while (!of_class.empty() && (of_class.size() > kOfClass || frame_ - of_class.front().frame >= kFrames)) {
      of_class.pop_front();
    }
    for (const Recent& recent : of_class) {
      observations_.all.push_back(recent.observation);
      observations_.all.back().age = frame_ - recent.frame;
    }
  }
  return observations_;
}

}  // namespace hulltrack
