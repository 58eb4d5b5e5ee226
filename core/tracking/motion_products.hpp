// What the loader's operator asks of the ship: how much deeper, heeled, trimmed and along the quay does she
// lie than when her map was made, and how fast does that change?
//
// Metres, radians, seconds. Signs: draft + deeper; heel + the side at smaller Y of W down (roll); trim + the
// end at larger X down (pitch: by the head if the bow points that way, by the stern otherwise); surge + along
// the quay towards larger X. Nothing is known without healthy poses, and that is said as nothing.
#pragma once

#include <optional>

namespace hulltrack {

/// Against the map, or the same a second.
struct ShipMotion {
  double draft = 0.0;  // of the middle of the mapped ship, m
  double heel = 0.0;   // rad
  double trim = 0.0;   // rad
  double surge = 0.0;  // of the reference point, m
};

struct MotionProducts {
  std::optional<ShipMotion> now;   // this frame's; only from a healthy pose
  std::optional<ShipMotion> rate;  // a second, over the last minute of healthy poses
  double mapped_length = 0.0;      // what a trim in metres is read over, m
};

}  // namespace hulltrack
