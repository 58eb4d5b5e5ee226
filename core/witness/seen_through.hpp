// Do rays pass through the quay where joints and mount put it?
//
// A machine that is metres off sees through surfaces of the quay's map. Counts each class of surfaces over
// some two seconds. Frame W, metres. Thread rule: a plain value of bounded size. No failure.
#pragma once

#include <array>
#include <deque>
#include <string>

#include "core/quay/quay_sight.hpp"

namespace hulltrack {

class SeenThrough {
 public:
  /// What a frame shows.
  void remember(const QuaySighting& sighting);
  /// The complaint in words, if rays pass through half of a class of the quay's planes, spread over more than
  /// one movable thing (QuaySearch::kLongestThing); else empty. A frame whose rays reached none of a class
  /// has no complaint of it: what earlier frames saw is theirs to say.
  [[nodiscard]] std::string complaint() const;

 private:
  struct Memory {               // of one class of planes; sums that lose 5 % a frame
    double reached = 0.0;       // planes that rays reached
    bool now = false;           // the last frame\'s did
    double through = 0.0;       // of these, planes that rays passed through
    std::deque<Point> where_W;  // middles of the last planes that were seen through
  };
  std::array<Memory, QuayMap::kClasses> planes_;
};

}  // namespace hulltrack
