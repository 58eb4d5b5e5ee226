// Finds the quay's top where nobody has measured it ([quay] height = "learn").
//
// It gathers the returns of 20 frames (two seconds) beside the hull's berth, on the loader's side, and looks
// for a plane in them (quay_top.hpp). The plane is as wrong as the joints were at that time: it can show that
// the joints have changed since, never that they are right. After five seconds without view of it, it is
// given up and looked for again. Frame W, metres. Failure: no plane yet. Thread rule: one owner.
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
  static constexpr int kFrames = 20;  // gathered before a plane is looked for
  static constexpr int kMisses = 50;  // frames in a row without view of the top, five seconds: it is given up
  /// Returns farther than this behind the slewing axis, away from the berth, are left out, m. Other things
  /// are level there, too: a yard on a fill, water and ships behind a jetty.
  static constexpr float kBehindAxis = 10.0F;

  struct Top {
    SeenTop seen;
    MachineStand stand;  // of the machine when the top was found
  };

  /// `hull_W`: the box in which the hull may lie; `rails_y_W`: Y of the slewing axis, m.
  TopLearner(const Box& hull_W, double rails_y_W)
      : hull_W_(hull_W), rails_y_W_(static_cast<float>(rails_y_W)) {}

  /// To be called for each frame while there is no top(): its returns outside of the hull's region.
  void add(std::span<const Point> returns_W, const MachineStand& stand);
  /// To be called for each frame while there is a top(). `enough`: the frame has enough returns where top()
  /// lies, on the plane or not.
  void seen(bool enough);
  /// To be called when the joints may have changed: returns of before and after do not belong together.
  void drop_gathered();
  /// To be called when the joints have been checked: a top found before says nothing of them.
  void forget();

  [[nodiscard]] const std::optional<Top>& top() const { return top_; }
  /// The first top since the joints were checked: a person may write it into the configuration.
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
