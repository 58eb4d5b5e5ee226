#include "daemon/simulator/ship/ship_mesh.hpp"

#include <algorithm>
#include <cmath>

#include "daemon/simulator/random.hpp"

namespace hulltrack {
namespace {

const Hatch* hatch_over(const ShipDesign& ship, float x) {
  for (const Hatch& hatch : ship.hatches)
    if (std::abs(x - hatch.centre) < 0.5F * hatch.length) return &hatch;
  return nullptr;
}

/// Cuts along the ship: shape changes lie on cuts, and no piece is longer than 3 m.
std::vector<float> frames_along(const ShipDesign& ship) {
  const float half = 0.5F * ship.length;
  std::vector<float> cuts = {-half, half, half - ship.bow_length + 1.0F};
  for (const Hatch& hatch : ship.hatches) {
    cuts.push_back(hatch.centre - 0.5F * hatch.length);
    cuts.push_back(hatch.centre + 0.5F * hatch.length);
  }
  constexpr float kSpacing = 3.0F;
  constexpr float kBowSpacing = 1.0F;
  for (float x = -half; x<half; x += x> half - ship.bow_length ? kBowSpacing : kSpacing) cuts.push_back(x);
  std::sort(cuts.begin(), cuts.end());
  return cuts;
}

/// Deck, shell and bulwark between two cuts.
void add_hull_piece(TriangleMesh& mesh, const ShipDesign& ship, float x0, float x1) {
  const float middle = 0.5F * (x0 + x1);
  const float step = deck_height(ship, middle) - deck_height(ship, x0);
  // A cut on the forecastle's break belongs to the piece on either side with that piece's height.
  const float z0 = std::abs(step) > 1.0F ? deck_height(ship, x0 + 0.01F) : deck_height(ship, x0);
  const float z1 = std::abs(deck_height(ship, x1) - deck_height(ship, middle)) > 1.0F
                       ? deck_height(ship, x1 - 0.01F)
                       : deck_height(ship, x1);
  const float b0 = half_breadth(ship, x0);
  const float b1 = half_breadth(ship, x1);
  const Hatch* hatch = hatch_over(ship, middle);
  const float gap = hatch != nullptr ? 0.5F * hatch->width : 0.0F;
  const bool at_end = middle > 0.5F * ship.length - ship.bow_length || hatch == nullptr;
  const float bulwark = at_end ? 1.1F : 0.35F;
  for (const float side : {-1.0F, 1.0F}) {
    add_quad(mesh, {x0, side * gap, z0}, {x1, side * gap, z1}, {x1, side * b1, z1}, {x0, side * b0, z0},
             Material::steel);
    add_quad(mesh, {x0, side * b0, -ship.depth}, {x1, side * b1, -ship.depth}, {x1, side * b1, z1 + bulwark},
             {x0, side * b0, z0 + bulwark}, Material::dark_steel);
  }
}

/// Posts and two bars above the low bulwark beside the hatches.
void add_rails(TriangleMesh& mesh, const ShipDesign& ship) {
  constexpr float kPostSpacing = 2.1F;
  const Hatch& first = ship.fitted_around.front();
  const float aft = first.centre - 0.5F * first.length;
  const float forward = 0.5F * ship.length - ship.bow_length;
  const float y = 0.5F * ship.beam - 0.08F;
  for (const float side : {-1.0F, 1.0F}) {
    for (float x = aft; x < forward; x += kPostSpacing) {
      const float z = deck_height(ship, x);
      add_cylinder(mesh, {x, side * y, z}, {x, side * y, z + 1.1F}, 0.03F, 6, Material::white_paint);
      for (const float bar : {0.72F, 1.1F})
        add_cylinder(mesh, {x, side * y, z + bar}, {x + kPostSpacing, side * y, z + bar}, 0.025F, 5,
                     Material::white_paint);
    }
  }
}

}  // namespace

TriangleMesh ship_mesh(const ShipDesign& ship) {
  TriangleMesh mesh;
  const std::vector<float> cuts = frames_along(ship);
  for (std::size_t i = 0; i + 1 < cuts.size(); ++i) add_hull_piece(mesh, ship, cuts[i], cuts[i + 1]);

  const float half = 0.5F * ship.length;
  const float transom = half_breadth(ship, -half);
  const float stern_z = deck_height(ship, -half);
  add_quad(mesh, {-half, -transom, -ship.depth}, {-half, transom, -ship.depth},
           {-half, transom, stern_z + 1.1F}, {-half, -transom, stern_z + 1.1F}, Material::dark_steel);
  const float brk = half - ship.bow_length + 1.0F;
  const float b = half_breadth(ship, brk);
  const float low = deck_height(ship, brk - 0.01F);
  add_quad(mesh, {brk, -b, low}, {brk, b, low}, {brk, b, low + ship.forecastle_height},
           {brk, -b, low + ship.forecastle_height}, Material::white_paint);

  for (const Hatch& hatch : ship.hatches) add_hatch(mesh, ship, hatch);
  add_rails(mesh, ship);
  add_house(mesh, ship);
  add_fittings(mesh, ship);
  return mesh;
}

TriangleMesh cargo_mesh(const ShipDesign& ship, float fill) {
  TriangleMesh mesh;
  RandomStream random(ship.fittings_seed, 11);
  for (const Hatch& hatch : ship.hatches) {
    const float x0 = hatch.centre - 0.5F * hatch.length;
    const float y0 = 0.5F * ship.beam - ship.side_tank_width;
    const auto level = static_cast<float>(random.uniform(0.6, 1.3)) * fill;
    const float floor = ship.tank_top + 0.5F * level * (-ship.tank_top);
    add_quad(mesh, {x0, -y0, floor}, {x0 + hatch.length, -y0, floor}, {x0 + hatch.length, y0, floor},
             {x0, y0, floor}, Material::ore);
    constexpr float kReposeSlope = 0.7F;  // 35 deg
    constexpr float kFirstHeap = 30.0F;   // m of radius a unit of level: a first thin layer has no heap on it
    const float radius = std::min({0.42F * hatch.length, -0.5F * floor / kReposeSlope, kFirstHeap * level});
    const auto shift = static_cast<float>(random.uniform(-0.06, 0.06)) * hatch.length;
    add_cone(mesh, {hatch.centre + shift, 0.0F, floor}, radius, kReposeSlope * radius, 24, Material::ore);
  }
  return mesh;
}

}  // namespace hulltrack
