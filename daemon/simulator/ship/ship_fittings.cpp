// The house aft and what stands on the decks: placed by the design's own seed, so that no hatch looks
// like the next.
#include <algorithm>

#include "daemon/simulator/random.hpp"
#include "daemon/simulator/ship/ship_mesh.hpp"

namespace hulltrack {
namespace {

float draw(RandomStream& random, double low, double high) {
  return static_cast<float>(random.uniform(low, high));
}

void add_vent(TriangleMesh& mesh, const Point& foot, RandomStream& random) {
  const float height = draw(random, 0.7, 1.7);
  const Point head = foot + Point(0.0F, 0.0F, height);
  add_cylinder(mesh, foot, head, 0.18F, 10, Material::white_paint);
  add_cylinder(mesh, head, head + Point(0.0F, 0.0F, 0.25F), 0.38F, 12, Material::white_paint);
}

void add_bollards(TriangleMesh& mesh, const Point& foot) {
  add_box(mesh, foot + Point(-0.7F, -0.25F, 0.0F), foot + Point(0.7F, 0.25F, 0.08F), Material::dark_steel);
  for (const float x : {-0.45F, 0.45F})
    add_cylinder(mesh, foot + Point(x, 0.0F, 0.0F), foot + Point(x, 0.0F, 0.6F), 0.17F, 12,
                 Material::dark_steel);
}

void add_winch(TriangleMesh& mesh, const Point& foot) {
  add_box(mesh, foot + Point(-0.9F, -0.6F, 0.0F), foot + Point(0.9F, 0.6F, 0.3F), Material::dark_steel);
  add_cylinder(mesh, foot + Point(0.0F, -0.8F, 0.8F), foot + Point(0.0F, 0.8F, 0.8F), 0.5F, 14,
               Material::steel);
  add_box(mesh, foot + Point(0.5F, 0.4F, 0.3F), foot + Point(1.1F, 0.9F, 1.3F), Material::steel);
}

void add_locker(TriangleMesh& mesh, const Point& foot, RandomStream& random) {
  add_box(mesh, foot, foot + Point(draw(random, 0.6, 2.2), draw(random, 0.6, 1.6), draw(random, 0.6, 2.0)),
          Material::steel);
}

/// The cross deck between two hatches, x in [x0, x1]: vents, a winch, lockers, now and then a mast.
void furnish_cross_deck(TriangleMesh& mesh, const ShipDesign& ship, float x0, float x1,
                        RandomStream& random) {
  const float z = deck_height(ship, 0.5F * (x0 + x1));
  const float y = 0.5F * ship.beam - 1.2F;
  const auto spot = [&] { return Point(draw(random, x0, x1), draw(random, -y, y), z); };
  const int vents = 2 + static_cast<int>(random.uniform(0.0, 4.0));
  for (int i = 0; i < vents; ++i) add_vent(mesh, spot(), random);
  for (int i = 0; i < 2; ++i) add_locker(mesh, spot(), random);
  if (random.uniform() < 0.6) add_winch(mesh, spot());
  if (random.uniform() < 0.5) {
    const Point foot = spot();
    add_cylinder(mesh, foot, foot + Point(0.0F, 0.0F, draw(random, 4.0, 7.0)), 0.2F, 12,
                 Material::white_paint);
  }
}

/// Along both sides: pipes, bollards, air pipes, lockers at irregular places.
void furnish_side_decks(TriangleMesh& mesh, const ShipDesign& ship, RandomStream& random) {
  const float aft = ship.fitted_around.front().centre - 0.5F * ship.fitted_around.front().length;
  const float forward = ship.fitted_around.back().centre + 0.5F * ship.fitted_around.back().length;
  const float y = 0.5F * ship.beam - 0.7F;
  for (const float side : {-1.0F, 1.0F}) {
    for (float x = aft; x < forward; x += draw(random, 3.0, 8.0)) {
      const Point foot(x, side * y, deck_height(ship, x));
      const double kind = random.uniform();
      if (kind < 0.3) {
        add_bollards(mesh, foot);
      } else if (kind < 0.75) {
        add_cylinder(mesh, foot, foot + Point(0.0F, 0.0F, draw(random, 0.5, 1.0)), 0.12F, 8, Material::steel);
      } else {
        add_box(mesh, foot + Point(0.0F, -0.3F, 0.0F),
                foot + Point(draw(random, 0.5, 1.4), 0.3F, draw(random, 0.4, 1.1)), Material::white_paint);
      }
    }
  }
  const float z = deck_height(ship, 0.0F);
  add_cylinder(mesh, {aft, y - 0.9F, z + 0.35F}, {forward, y - 0.9F, z + 0.35F}, 0.11F, 8, Material::steel);
}

void furnish_forecastle(TriangleMesh& mesh, const ShipDesign& ship) {
  const float x = 0.5F * ship.length - 0.55F * ship.bow_length;
  const float z = deck_height(ship, x);
  for (const float side : {-1.0F, 1.0F}) {
    add_winch(mesh, {x, side * 2.4F, z});
    add_bollards(mesh, {x - 3.5F, side * 5.0F, z});
  }
  add_cylinder(mesh, {x - 3.0F, 0.0F, z}, {x - 3.0F, 0.0F, z + 6.5F}, 0.25F, 12, Material::white_paint);
}

/// One storey with a row of windows set into its front.
void add_storey(TriangleMesh& mesh, const Point& min, const Point& max) {
  add_box(mesh, min, max, Material::white_paint);
  const float sill = min.z() + 1.1F;
  for (float y = min.y() + 0.8F; y + 1.0F < max.y(); y += 1.9F)
    add_box(mesh, {max.x(), y, sill}, {max.x() + 0.04F, y + 0.8F, sill + 0.8F}, Material::glass);
}

}  // namespace

void add_house(TriangleMesh& mesh, const ShipDesign& ship) {
  constexpr int kStoreys = 4;
  const float x0 = ship.house_aft_end;
  const float deck = deck_height(ship, x0);
  const float storey = ship.house_height / static_cast<float>(kStoreys);
  for (int i = 0; i < kStoreys; ++i) {
    const auto level = static_cast<float>(i);
    const float half = 0.5F * ship.beam - 1.0F - 0.7F * level;
    const float z = deck + storey * level;
    add_storey(mesh, {x0 + 0.5F * level, -half, z},
               {x0 + ship.house_length - 0.8F * level, half, z + storey});
  }
  const float top = deck + ship.house_height;
  const float bridge_x = x0 + ship.house_length - 4.5F;
  add_box(mesh, {bridge_x, -0.5F * ship.beam, top - storey},
          {bridge_x + 2.0F, 0.5F * ship.beam, top - storey + 1.1F}, Material::white_paint);
  add_cylinder(mesh, {bridge_x, 0.0F, top}, {bridge_x, 0.0F, top + 5.0F}, 0.22F, 12, Material::white_paint);
  add_box(mesh, {x0 + 0.8F, -1.5F, top}, {x0 + 3.6F, 1.5F, top + 3.2F}, Material::dark_steel);
}

void add_fittings(TriangleMesh& mesh, const ShipDesign& ship) {
  RandomStream random(ship.fittings_seed, 7);
  constexpr float kCoversReach = 1.7F;  // the folded covers' share of the cross deck, both ends alike
  for (std::size_t i = 0; i + 1 < ship.fitted_around.size(); ++i) {
    const float x0 = ship.fitted_around[i].centre + 0.5F * ship.fitted_around[i].length + 0.6F;
    const float x1 = ship.fitted_around[i + 1].centre - 0.5F * ship.fitted_around[i + 1].length - 0.6F;
    const float aft_limit = ship.fitted_around[i].covers == Covers::aft ? x0 : x0 + kCoversReach;
    const float forward_limit = ship.fitted_around[i + 1].covers == Covers::aft ? x1 - kCoversReach : x1;
    if (aft_limit + 0.3F < forward_limit) furnish_cross_deck(mesh, ship, aft_limit, forward_limit, random);
  }
  const float house_front = ship.house_aft_end + ship.house_length;
  const float first_hatch = ship.fitted_around.front().centre - 0.5F * ship.fitted_around.front().length;
  furnish_cross_deck(mesh, ship, house_front + 0.6F, first_hatch - 2.8F, random);
  furnish_side_decks(mesh, ship, random);
  furnish_forecastle(mesh, ship);
}

}  // namespace hulltrack
