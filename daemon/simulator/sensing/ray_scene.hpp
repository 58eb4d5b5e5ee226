// What does a ray meet first? One rigid body's mesh behind a bounding volume hierarchy (Embree 3).
//
// Rays and answers are in the body's own frame, metres; a direction need not have length 1 and
// distances are multiples of it. Built once (throws std::runtime_error if Embree refuses), immutable
// afterwards: any number of threads may cast. About 0.3 us a ray.
#pragma once

#include <memory>
#include <optional>

#include "daemon/simulator/sensing/mesh.hpp"

namespace hulltrack {

struct RayHit {
  float distance;       // along the ray, in lengths of its direction
  float cos_incidence;  // |cos| of the angle between ray and surface normal: 1 = head on
  Material material;
  Point normal;  // of the surface, length 1, on either side
};

class RayScene {
 public:
  explicit RayScene(TriangleMesh mesh);
  ~RayScene();
  RayScene(RayScene&&) noexcept;
  RayScene& operator=(RayScene&&) noexcept;

  /// The nearest surface at distances in (0, max_distance), if there is one.
  [[nodiscard]] std::optional<RayHit> cast(const Point& origin, const Point& direction,
                                           float max_distance) const;
  /// Is any surface in the way at distances in (0, max_distance)?
  [[nodiscard]] bool blocked(const Point& origin, const Point& direction, float max_distance) const;

  [[nodiscard]] const TriangleMesh& mesh() const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace hulltrack
