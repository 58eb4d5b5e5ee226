// One hatch: the coaming with its stays, the hold below it, the covers folded at one end or closed.
#include "daemon/simulator/ship/ship_mesh.hpp"

#include <algorithm>
#include <cmath>

#include "daemon/simulator/random.hpp"

namespace hulltrack {
namespace {

constexpr float kCoamingThickness = 0.35F;  // to the edge of the rest bar

struct Opening {
  float x0, x1, y, deck, top;  // |y| of the sides; z of deck and of the coaming's top
};

void add_coaming(TriangleMesh& mesh, const Opening& o) {
  const float t = kCoamingThickness;
  for (const float side : {-1.0F, 1.0F}) {
    const float inner = side * o.y;
    const float outer = side * (o.y + t);
    add_box(mesh, {o.x0 - t, std::min(inner, outer), o.deck - 0.3F},
            {o.x1 + t, std::max(inner, outer), o.top}, Material::steel);
  }
  add_box(mesh, {o.x0 - t, -o.y, o.deck - 0.3F}, {o.x0, o.y, o.top}, Material::steel);
  add_box(mesh, {o.x1, -o.y, o.deck - 0.3F}, {o.x1 + t, o.y, o.top}, Material::steel);
}

/// Bracket plates that hold the coaming upright, at the irregular spacing of the frames.
void add_stays(TriangleMesh& mesh, const Opening& o, RandomStream& random) {
  constexpr float kReach = 0.55F;
  constexpr float kPlate = 0.03F;
  const float foot = o.y + kCoamingThickness;
  for (auto x = o.x0 + static_cast<float>(random.uniform(0.3, 1.2)); x < o.x1;
       x += static_cast<float>(random.uniform(1.8, 2.7)))
    for (const float side : {-1.0F, 1.0F})
      add_box(mesh, {x, std::min(side * foot, side * (foot + kReach)), o.deck},
              {x + kPlate, std::max(side * foot, side * (foot + kReach)), o.top - 0.25F}, Material::steel);
}

void add_hold(TriangleMesh& mesh, const ShipDesign& ship, const Opening& o) {
  const float y = 0.5F * ship.beam - ship.side_tank_width;
  const float z = ship.tank_top;
  constexpr float kHopper = 1.8F;  // sloping lower wing tanks, as high as wide
  add_quad(mesh, {o.x0, -y, z}, {o.x1, -y, z}, {o.x1, y, z}, {o.x0, y, z}, Material::dark_steel);
  for (const float x : {o.x0, o.x1})
    add_quad(mesh, {x, -y, z}, {x, y, z}, {x, y, o.deck - 0.3F}, {x, -y, o.deck - 0.3F},
             Material::dark_steel);
  for (const float side : {-1.0F, 1.0F}) {
    add_quad(mesh, {o.x0, side * y, z + kHopper}, {o.x1, side * y, z + kHopper}, {o.x1, side * y, o.deck},
             {o.x0, side * y, o.deck}, Material::dark_steel);
    add_quad(mesh, {o.x0, side * (y - kHopper), z}, {o.x1, side * (y - kHopper), z},
             {o.x1, side * y, z + kHopper}, {o.x0, side * y, z + kHopper}, Material::dark_steel);
  }
}

/// Panels standing on edge, side by side, on the coaming's end.
void add_folded_covers(TriangleMesh& mesh, const Hatch& hatch, const Opening& o, RandomStream& random) {
  constexpr int kPanels = 4;
  constexpr float kPanelThickness = 0.28F;
  const bool aft = hatch.covers == Covers::aft;
  const float away = aft ? -1.0F : 1.0F;
  const float start = aft ? o.x0 : o.x1;
  for (int i = 0; i < kPanels; ++i) {
    const float a = start + away * (0.05F + 0.42F * static_cast<float>(i));
    const float b = a + away * kPanelThickness;
    const float height = hatch.cover_height - static_cast<float>(random.uniform(0.0, 0.25));
    add_box(mesh, {std::min(a, b), -o.y - 0.2F, o.top}, {std::max(a, b), o.y + 0.2F, o.top + height},
            Material::steel);
  }
}

/// Panels side by side over the opening, a hand's breadth apart in height where they overlap.
void add_closed_covers(TriangleMesh& mesh, const Opening& o) {
  constexpr int kPanels = 4;
  constexpr float kPanelDepth = 0.65F;
  constexpr float kStagger = 0.08F;
  const float length = (o.x1 - o.x0) / kPanels;
  for (int i = 0; i < kPanels; ++i) {
    const float x = o.x0 + static_cast<float>(i) * length;
    const float top = o.top + kPanelDepth + (i % 2 == 0 ? 0.0F : kStagger);
    add_box(mesh, {x, -o.y - 0.2F, o.top}, {x + length, o.y + 0.2F, top}, Material::steel);
  }
}

}  // namespace

void add_hatch(TriangleMesh& mesh, const ShipDesign& ship, const Hatch& hatch) {
  RandomStream random(ship.fittings_seed, 5, hatch.details);
  const float deck = deck_height(ship, hatch.centre);
  const Opening opening{hatch.centre - 0.5F * hatch.length, hatch.centre + 0.5F * hatch.length,
                        0.5F * hatch.width, deck, deck + hatch.coaming_height};
  add_coaming(mesh, opening);
  add_stays(mesh, opening, random);
  add_hold(mesh, ship, opening);
  if (hatch.covers == Covers::closed)
    add_closed_covers(mesh, opening);
  else
    add_folded_covers(mesh, hatch, opening, random);
}

}  // namespace hulltrack
