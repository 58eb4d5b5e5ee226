#include "daemon/simulator/ship/ship_design.hpp"

#include <algorithm>
#include <array>
#include <cmath>

namespace hulltrack {

ShipDesign berth_ship() {
  ShipDesign ship;
  ship.hatches = {{-32.0F, 17.5F, 12.6F, 1.30F, Covers::aft, 1.9F, 99680},
                  {-10.0F, 18.2F, 12.6F, 1.30F, Covers::aft, 2.2F, 99900},
                  {12.6F, 18.2F, 12.6F, 1.45F, Covers::forward, 2.0F, 100126},
                  {32.8F, 15.4F, 11.4F, 1.60F, Covers::forward, 1.7F, 100328}};
  ship.fitted_around = ship.hatches;
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
  ship.hatches = {{-37.0F, 13.4F, 14.0F, 1.20F, Covers::forward, 1.6F, 99630},
                  {-20.2F, 14.2F, 14.0F, 1.20F, Covers::aft, 1.8F, 99798},
                  {-2.6F, 14.2F, 14.0F, 1.35F, Covers::forward, 1.8F, 99974},
                  {15.1F, 14.2F, 14.0F, 1.35F, Covers::aft, 2.1F, 100151},
                  {33.2F, 12.8F, 12.4F, 1.50F, Covers::aft, 1.6F, 100332}};
  ship.fitted_around = ship.hatches;
  ship.fittings_seed = 77;
  return ship;
}

ShipDesign sister_with_other_hatch_places() {
  ShipDesign ship = berth_ship();
  constexpr std::array kShift = {0.24F, -0.15F, 0.12F, -0.28F};
  for (std::size_t i = 0; i < kShift.size(); ++i) ship.hatches.at(i).centre += kShift.at(i);
  return ship;
}

ShipDesign sister_with_other_coamings() {
  ShipDesign ship = berth_ship();
  constexpr std::array kHigher = {0.15F, -0.25F, 0.30F, -0.12F};
  for (std::size_t i = 0; i < kHigher.size(); ++i) ship.hatches.at(i).coaming_height += kHigher.at(i);
  return ship;
}

ShipDesign sister_with_other_openings() {
  ShipDesign ship = berth_ship();
  constexpr std::array kLonger = {0.25F, -0.20F, 0.30F, -0.15F};
  constexpr std::array kWider = {-0.20F, 0.30F, -0.25F, 0.20F};
  for (std::size_t i = 0; i < kLonger.size(); ++i) {
    ship.hatches.at(i).length += kLonger.at(i);
    ship.hatches.at(i).width += kWider.at(i);
  }
  return ship;
}

ShipDesign ship_with_moved_covers() {
  ShipDesign ship = berth_ship();
  constexpr std::array kNow = {Covers::closed, Covers::forward, Covers::aft, Covers::closed};
  for (std::size_t i = 0; i < kNow.size(); ++i) ship.hatches.at(i).covers = kNow.at(i);
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
