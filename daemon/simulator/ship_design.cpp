#include "daemon/simulator/ship_design.hpp"

#include <algorithm>
#include <cmath>

namespace hulltrack {

ShipDesign berth_ship() {
  ShipDesign ship;
  ship.hatches = {{-32.0F, 17.5F, 12.6F, 1.30F, true, 1.9F},
                  {-10.0F, 18.2F, 12.6F, 1.30F, true, 2.2F},
                  {12.6F, 18.2F, 12.6F, 1.45F, false, 2.0F},
                  {32.8F, 15.4F, 11.4F, 1.60F, false, 1.7F}};
  return ship;
}

ShipDesign stranger_ship() {
  ShipDesign ship;
  ship.length = 127.0F;
  ship.beam = 21.2F;
  ship.depth = 10.6F;
  ship.bow_length = 15.0F;
  ship.stern_length = 10.0F;
  ship.forecastle_height = 2.6F;
  ship.house_length = 10.0F;
  ship.house_height = 13.5F;
  ship.house_aft_end = -58.0F;
  ship.hatches = {{-37.0F, 13.4F, 14.0F, 1.20F, false, 1.6F},
                  {-20.2F, 14.2F, 14.0F, 1.20F, true, 1.8F},
                  {-2.6F, 14.2F, 14.0F, 1.35F, false, 1.8F},
                  {15.1F, 14.2F, 14.0F, 1.35F, true, 2.1F},
                  {33.2F, 12.8F, 12.4F, 1.50F, true, 1.6F}};
  ship.fittings_seed = 77;
  return ship;
}

float half_breadth(const ShipDesign& ship, float x) {
  const float half = 0.5F * ship.length;
  const float full = 0.5F * ship.beam;
  if (std::abs(x) > half) return 0.0F;
  if (x > half - ship.bow_length) {
    const float s = (x - (half - ship.bow_length)) / ship.bow_length;
    return full * (1.0F - std::pow(s, 2.4F));
  }
  if (x < -half + ship.stern_length) {
    const float s = (-half + ship.stern_length - x) / ship.stern_length;
    return full * (1.0F - 0.3F * s * s);
  }
  return full;
}

float deck_height(const ShipDesign& ship, float x) {
  constexpr float kSheerForward = 0.9F;  // m at the stem
  constexpr float kSheerAft = 0.4F;      // m at the transom
  const float s = x / (0.5F * ship.length);
  const float sheer = (s > 0.0F ? kSheerForward : kSheerAft) * s * s * std::abs(s);
  const bool on_forecastle = x > 0.5F * ship.length - ship.bow_length + 1.0F;
  return sheer + (on_forecastle ? ship.forecastle_height : 0.0F);
}

Point landmark(const ShipDesign& ship) {
  const Hatch& hatch = ship.hatches.at(1);
  const float x = hatch.centre + 0.5F * hatch.length;
  return {x, -0.5F * hatch.width, deck_height(ship, hatch.centre) + hatch.coaming_height};
}

}  // namespace hulltrack
