#include "daemon/simulator/berth/berth_mesh.hpp"

#include "daemon/simulator/berth/quay_ground.hpp"

namespace hulltrack {
namespace {

constexpr float kEnd = kQuayHalfLength;

/// On the ground at (x, y): x and y of the corners about it, z from below the surface up to `height` above.
void add_standing_box(TriangleMesh& mesh, float x, float y, const Point& half_size, Material material) {
  constexpr float kSunk = 0.1F;
  const float ground = quay_top(x, y);
  add_box(mesh, {x - half_size.x(), y - half_size.y(), ground - kSunk},
          {x + half_size.x(), y + half_size.y(), ground + 2.0F * half_size.z()}, material);
}

void add_post(TriangleMesh& mesh, float x, float y, float height, float radius, Material material) {
  const float ground = quay_top(x, y);
  add_cylinder(mesh, {x, y, ground}, {x, y, ground + height}, radius, 12, material);
}

/// Kerb, rails, bollards, capstans and fenders.
void add_waterfront(TriangleMesh& mesh) {
  add_box(mesh, {-kEnd, -0.5F, -0.4F}, {kEnd, 0.0F, 0.1F}, Material::concrete);
  for (const float y : {-3.0F, -13.5F})
    add_box(mesh, {-kEnd, y - 0.08F, -0.5F}, {kEnd, y + 0.08F, 0.0F}, Material::dark_steel);
  constexpr float kBollards = 25.0F;
  for (float x = -kEnd + 10.0F; x < kEnd; x += kBollards) {
    add_standing_box(mesh, x, -1.2F, {0.5F, 0.5F, 0.06F}, Material::concrete);
    add_post(mesh, x, -1.2F, 0.75F, 0.3F, Material::dark_steel);
    const float head = quay_top(x, -1.2F) + 0.6F;
    add_cylinder(mesh, {x, -1.2F, head}, {x, -1.2F, head + 0.22F}, 0.42F, 12, Material::dark_steel);
    add_post(mesh, x + 11.0F, -1.7F, 0.9F, 0.3F, Material::steel);  // capstan
  }
  constexpr float kFenders = 12.5F;
  for (float x = -kEnd + 4.0F; x < kEnd; x += kFenders)
    add_box(mesh, {x, 0.0F, -4.5F}, {x + 1.8F, 1.0F, -0.5F}, Material::rubber);
}

/// Crash barrier, switch cabinets and light masts behind the land rail.
void add_roadside(TriangleMesh& mesh) {
  constexpr float kPiece = 5.0F;
  constexpr float kGap = 2.5F;
  for (float x = -kEnd + 7.0F; x < kEnd - kPiece; x += kPiece + kGap)
    add_standing_box(mesh, x + 0.5F * kPiece, -16.1F, {0.5F * kPiece, 0.25F, 0.45F}, Material::concrete);
  constexpr float kCabinets = 16.0F;
  for (float x = -kEnd + 5.0F; x < kEnd; x += kCabinets) {
    add_standing_box(mesh, x, -15.3F, {0.8F, 0.4F, 1.0F}, Material::white_paint);
    add_standing_box(mesh, x + 2.2F, -15.3F, {0.5F, 0.4F, 0.75F}, Material::steel);
  }
  constexpr float kMasts = 50.0F;
  for (float x = -kEnd + 12.0F; x < kEnd; x += kMasts) {
    add_standing_box(mesh, x, -17.0F, {0.6F, 0.6F, 0.4F}, Material::concrete);
    add_post(mesh, x, -17.0F, 24.0F, 0.22F, Material::steel);
  }
}

/// Conveyor gallery along the quay on braced trestles, with its transfer towers.
void add_conveyor(TriangleMesh& mesh) {
  constexpr float kUnderside = 6.0F;
  add_box(mesh, {-kEnd, -21.0F, kUnderside}, {kEnd, -18.0F, 8.5F}, Material::steel);
  constexpr float kTrestles = 12.0F;
  for (float x = -kEnd + 4.0F; x < kEnd; x += kTrestles) {
    for (const float y : {-20.5F, -18.4F}) {
      add_box(mesh, {x - 0.25F, y - 0.25F, quay_top(x, y)}, {x + 0.25F, y + 0.25F, kUnderside},
              Material::steel);
      add_standing_box(mesh, x, y, {0.6F, 0.6F, 0.25F}, Material::concrete);
    }
    add_cylinder(mesh, {x, -20.5F, 0.0F}, {x, -18.4F, kUnderside}, 0.1F, 8, Material::steel);
  }
  for (const float x : {-92.0F, -24.0F, 44.0F, 112.0F}) {
    add_standing_box(mesh, x, -20.0F, {3.5F, 3.2F, 7.0F}, Material::white_paint);
    add_box(mesh, {x - 1.5F, -24.0F, 9.0F}, {x + 1.5F, -23.2F, 12.0F}, Material::steel);
  }
}

/// A shed along x with a pitched roof.
void add_shed(TriangleMesh& mesh, const Point& min, const Point& max, float ridge) {
  add_box(mesh, min, max, Material::white_paint);
  const float middle = 0.5F * (min.y() + max.y());
  const float eaves = max.z();
  for (const float y : {min.y(), max.y()})
    add_quad(mesh, {min.x(), y, eaves}, {max.x(), y, eaves}, {max.x(), middle, ridge},
             {min.x(), middle, ridge}, Material::steel);
  for (const float x : {min.x(), max.x()})
    add_quad(mesh, {x, min.y(), eaves}, {x, max.y(), eaves}, {x, middle, ridge}, {x, middle, ridge},
             Material::white_paint);
}

void add_yard(TriangleMesh& mesh) {
  constexpr float kBase = -1.0F;  // below the ground everywhere
  add_shed(mesh, {-70.0F, -75.0F, kBase}, {-15.0F, -50.0F, 12.0F}, 15.0F);
  add_shed(mesh, {-60.0F, -42.0F, kBase}, {-36.0F, -31.0F, 6.0F}, 7.5F);
  add_shed(mesh, {62.0F, -44.0F, kBase}, {94.0F, -31.0F, 6.5F}, 8.0F);
  add_box(mesh, {6.0F, -33.0F, kBase}, {17.0F, -26.0F, 4.0F}, Material::white_paint);       // substation
  add_box(mesh, {-128.0F, -34.0F, kBase}, {-108.0F, -26.0F, 5.0F}, Material::white_paint);  // workshop
  add_cone(mesh, {20.0F, -55.0F, quay_top(20.0F, -55.0F)}, 17.0F, 12.0F, 32, Material::ore);
  add_cone(mesh, {48.0F, -59.0F, quay_top(48.0F, -59.0F)}, 14.0F, 9.5F, 32, Material::ore);
}

}  // namespace

TriangleMesh berth_mesh() {
  TriangleMesh mesh;
  add_quay_ground(mesh);
  add_waterfront(mesh);
  add_roadside(mesh);
  add_conveyor(mesh);
  add_yard(mesh);
  return mesh;
}

TriangleMesh water_mesh() {
  TriangleMesh mesh;
  constexpr float kReach = 400.0F;
  add_quad(mesh, {-kReach, 0.0F, kWaterLevel}, {kReach, 0.0F, kWaterLevel}, {kReach, kReach, kWaterLevel},
           {-kReach, kReach, kWaterLevel}, Material::water);
  return mesh;
}

TriangleMesh crane_mesh() {
  TriangleMesh mesh;
  const float ground = kQuayHeight;
  const Point heel(-1.0F, -1.3F, 3.2F);
  const Point head(0.5F, 5.2F, 9.5F);
  const Point load(0.5F, 5.2F, 4.6F);
  add_box(mesh, {-4.5F, -2.4F, ground + 0.5F}, {4.5F, -0.3F, 1.9F}, Material::white_paint);
  for (const float x : {-3.5F, -1.8F, 1.8F, 3.5F})
    add_cylinder(mesh, {x, -2.4F, ground + 0.6F}, {x, -0.3F, ground + 0.6F}, 0.6F, 12, Material::rubber);
  add_box(mesh, {-2.5F, -2.3F, 1.9F}, {0.5F, -0.4F, 3.6F}, Material::white_paint);
  add_cylinder(mesh, heel, head, 0.35F, 8, Material::white_paint);
  add_cylinder(mesh, head, load, 0.05F, 6, Material::dark_steel);
  add_box(mesh, load - Point(0.9F, 0.6F, 1.0F), load + Point(0.9F, 0.6F, 0.0F), Material::steel);
  return mesh;
}

}  // namespace hulltrack
