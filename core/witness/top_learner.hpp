// The quay's top that nobody has measured ([quay] height = "learn"): where this session saw it.
//
// Found from the returns of two seconds, on the side of the hull's berth on which the loader stands; found
// anew where the machine looks at another part of the quay for long. It is as wrong as the joints were when
// it was found, so it can show that they have changed since, never that they are right. Frame W, metres.
// Thread rule: one owner.
#pragma once

#include <cstdint>
#include <optional>
#include <span>

#include "core/geometry/cloud.hpp"
#include "core/quay/quay_top.hpp"
#include "core/witness/machine_wear.hpp"

namespace hulltrack {

class TopLearner {
 public:
  static constexpr int kFrames = 20;
  static constexpr int kMisses = 50;  // frames in a row: five seconds of another part of the quay
  /// m: from the slewing axis away from the berth. Behind the rails other things are level, too: a yard on a
  /// fill, water and ships behind a jetty.
  static constexpr float kBehindAxis = 10.0F;

  struct Top {
    SeenTop seen;
    MachineStand stand;  // of the machine when it was found
  };

  /// `hull_W`: where the hull may lie; `rails_y_W`: where the loader travels.
  TopLearner(const Box& hull_W, double rails_y_W)
      : hull_W_(hull_W), rails_y_W_(static_cast<float>(rails_y_W)) {}

  /// Returns of one frame that are outside the hull's region. While there is no top().
  void add(std::span<const Point> returns_W, const MachineStand& stand);
  /// Whether a frame had enough returns where top() lies, on it or not.
  void seen(bool enough);
  /// What was gathered so far is of other joints than what comes.
  void drop_gathered();
  /// Joints have been checked: what was found before says nothing of them.
  void forget();

  [[nodiscard]] const std::optional<Top>& top() const { return top_; }
  /// The first one that was found since the joints were checked, for the people who may write it down.
  [[nodiscard]] const std::optional<SeenTop>& first() const { return first_; }

 private:
  [[nodiscard]] bool may_be_quay(const Point& p_W) const;

  Box hull_W_;
  float rails_y_W_;
  Cloud gathered_W_;
  int frames_ = 0;
  int misses_ = 0;
  std::optional<Top> top_;
  std::optional<SeenTop> first_;
};

}  // namespace hulltrack
