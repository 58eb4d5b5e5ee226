#include "core/witness/top_learner.hpp"

#include "core/quay/quay_sight.hpp"

namespace hulltrack {

bool TopLearner::may_be_quay(const Point& p_W) const {
  if (rails_y_W_ < hull_W_.min.y()) {
    return p_W.y() < hull_W_.min.y() && p_W.y() > rails_y_W_ - kBehindAxis;
  }
  if (rails_y_W_ > hull_W_.max.y()) {
    return p_W.y() > hull_W_.max.y() && p_W.y() < rails_y_W_ + kBehindAxis;
  }
  return false;  // the rails lie inside of the berth's box: neither side is known to be the quay
}

void TopLearner::add(std::span<const Point> returns_W, const MachineStand& stand) {
  const Point sensor_W = stand.sensor_W.cast<float>();
  for (const Point& p : returns_W) {
    if (may_be_quay(p) && (p - sensor_W).norm() <= QuaySight::kFarthest) {
      gathered_W_.push_back(p);
    }
  }
  if (++frames_ < kFrames) {
    return;
  }
  if (const std::optional<SeenTop> found = find_quay_top(gathered_W_)) {
    top_ = Top{*found, stand};
    first_ = first_ ? first_ : found;
  }
  drop_gathered();
}

void TopLearner::seen(bool enough) {
  misses_ = enough ? 0 : misses_ + 1;
  if (misses_ >= kMisses) {
    misses_ = 0;
    top_.reset();
  }
}

void TopLearner::drop_gathered() {
  gathered_W_.clear();
  frames_ = 0;
}

void TopLearner::forget() {
  drop_gathered();
  misses_ = 0;
  top_.reset();
  first_.reset();
}

}  // namespace hulltrack
