// What the checks of one frame object: the state that is left of tracking, and why.
//
// A plain value.
#pragma once

#include <string>
#include <utility>

#include "core/base/status.hpp"

namespace hulltrack {

/// Collects objections: the worst state, all fault bits, and the reason of the first check that gave that
/// state.
struct Objections {
  State state = State::tracking;
  Faults faults = 0;
  std::string reason;

  void add(State at_best, Faults bits, std::string why) {
    faults |= bits;
    if (at_best > state) {  // tracking 1 < degraded 2 < lost 3
      state = at_best;
      reason = std::move(why);
    }
  }
};

}  // namespace hulltrack
