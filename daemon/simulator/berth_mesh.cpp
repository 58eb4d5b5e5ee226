#include "daemon/simulator/berth_mesh.hpp"

namespace hulltrack {
namespace {

constexpr float kHalfLength = 160.0F;  // of the quay, along x

void add_quay(TriangleMesh& mesh) {
  add_box(mesh, {-kHalfLength, -90.0F, -12.0F}, {kHalfLength, 0.0F, -0.15F}, Material::concrete);
  add_box(mesh, {-kHalfLength, -0.5F, -0.15F}, {kHalfLength, 0.0F, 0.1F}, Material::concrete);  // kerb
  for (const float y : {-3.0F, -13.5F})
    add_box(mesh, {-kHalfLength, y - 0.08F, -0.15F}, {kHalfLength, y + 0.08F, 0.0F}, Material::dark_steel);
  constexpr float kSpacing = 14.0F;
  for (float x = -kHalfLength + 6.0F; x < kHalfLength; x += kSpacing) {
    add_cylinder(mesh, {x, -1.2F, -0.15F}, {x, -1.2F, 0.6F}, 0.3F, 12, Material::dark_steel);
    add_box(mesh, {x + 5.0F, 0.0F, -4.5F}, {x + 6.6F, 1.0F, -0.6F}, Material::rubber);
  }
}

void add_yard(TriangleMesh& mesh) {
  constexpr float kGround = -0.15F;
  // Conveyor gallery along the quay on trestles.
  add_box(mesh, {-kHalfLength, -21.0F, 6.0F}, {kHalfLength, -18.0F, 8.5F}, Material::steel);
  for (float x = -kHalfLength + 4.0F; x < kHalfLength; x += 18.0F)
    for (const float y : {-20.7F, -18.6F})
      add_box(mesh, {x, y, kGround}, {x + 0.4F, y + 0.4F, 6.0F}, Material::steel);
  add_box(mesh, {-70.0F, -75.0F, kGround}, {-15.0F, -50.0F, 14.0F}, Material::white_paint);  // shed
  add_cone(mesh, {20.0F, -45.0F, kGround}, 17.0F, 12.0F, 32, Material::ore);
  add_cone(mesh, {48.0F, -47.0F, kGround}, 14.0F, 9.5F, 32, Material::ore);
  add_box(mesh, {-22.0F, -9.0F, kGround}, {-16.5F, -6.6F, 2.6F}, Material::white_paint);  // lorry
  add_box(mesh, {36.0F, -6.0F, kGround}, {38.2F, -4.8F, 1.9F}, Material::steel);          // van
  for (const float x : {-48.0F, 2.0F, 52.0F})
    add_cylinder(mesh, {x, -16.0F, kGround}, {x, -16.0F, 18.0F}, 0.2F, 10, Material::steel);  // lamp posts
}

}  // namespace

TriangleMesh berth_mesh() {
  TriangleMesh mesh;
  add_quay(mesh);
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
  constexpr float kGround = -0.15F;
  const Point heel(-1.0F, -1.3F, 3.2F);
  const Point head(0.5F, 5.2F, 9.5F);
  const Point load(0.5F, 5.2F, 4.6F);
  add_box(mesh, {-4.5F, -2.4F, kGround + 0.5F}, {4.5F, -0.3F, 1.9F}, Material::white_paint);
  for (const float x : {-3.5F, -1.8F, 1.8F, 3.5F})
    add_cylinder(mesh, {x, -2.4F, kGround + 0.6F}, {x, -0.3F, kGround + 0.6F}, 0.6F, 12, Material::rubber);
  add_box(mesh, {-2.5F, -2.3F, 1.9F}, {0.5F, -0.4F, 3.6F}, Material::white_paint);
  add_cylinder(mesh, heel, head, 0.35F, 8, Material::white_paint);
  add_cylinder(mesh, head, load, 0.05F, 6, Material::dark_steel);
  add_box(mesh, load - Point(0.9F, 0.6F, 1.0F), load + Point(0.9F, 0.6F, 0.0F), Material::steel);
  return mesh;
}

}  // namespace hulltrack
