#include "daemon/simulator/berth/quay_ground.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

namespace hulltrack {
namespace {

constexpr float kYardRise = 0.005F;  // behind the gutter
constexpr float kFoot = -12.0F;      // z of the quay wall's foot

/// One ripple of the top: how high, how long, which way it runs.
struct Ripple {
  float amplitude;   // m
  float wavelength;  // m
  float heading;     // rad from x
  float phase;       // rad
};
constexpr std::array<Ripple, 5> kRipples = {{{0.010F, 37.0F, 0.4F, 0.9F},
                                             {0.008F, 23.0F, 1.9F, 2.3F},
                                             {0.006F, 17.0F, 2.8F, 4.1F},
                                             {0.004F, 13.0F, 1.1F, 5.6F},
                                             {0.003F, 9.0F, 0.1F, 1.7F}}};

float unevenness(float x, float y) {
  float z = 0.0F;
  for (const Ripple& r : kRipples) {
    const float along = x * std::cos(r.heading) + y * std::sin(r.heading);
    z += r.amplitude * std::sin(2.0F * std::numbers::pi_v<float> * along / r.wavelength + r.phase);
  }
  return z;
}

}  // namespace

float quay_top(float x, float y) {
  const float beyond_gutter = std::max(0.0F, kGutter - y);
  const float plane = kQuayHeight + kQuaySlopeX * x + kQuaySlopeY * std::max(y, kGutter);
  return plane + kYardRise * beyond_gutter + unevenness(x, y);
}

void add_quay_ground(TriangleMesh& mesh) {
  constexpr float kStep = 2.0F;  // m: the shortest ripple has more than four steps
  const auto top = [](float x, float y) { return Point(x, y, quay_top(x, y)); };
  for (float x = -kQuayHalfLength; x < kQuayHalfLength; x += kStep) {
    for (float y = -kQuayDepth; y < 0.0F; y += kStep)
      add_quad(mesh, top(x, y), top(x + kStep, y), top(x + kStep, y + kStep), top(x, y + kStep),
               Material::concrete);
    add_quad(mesh, {x, 0.0F, kFoot}, {x + kStep, 0.0F, kFoot}, top(x + kStep, 0.0F), top(x, 0.0F),
             Material::concrete);
  }
}

}  // namespace hulltrack
