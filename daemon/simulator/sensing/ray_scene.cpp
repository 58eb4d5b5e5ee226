#include "daemon/simulator/sensing/ray_scene.hpp"

#include <embree3/rtcore.h>

#include <memory>
#include <stdexcept>
#include <utility>

namespace hulltrack {
namespace {

/// Copies into a buffer that Embree owns and pads as its SIMD loads need.
template <typename Element>
void fill_buffer(RTCGeometry geometry, RTCBufferType type, RTCFormat format,
                 const std::vector<Element>& data) {
  void* buffer = rtcSetNewGeometryBuffer(geometry, type, 0, format, sizeof(Element), data.size());
  if (buffer == nullptr) throw std::runtime_error("simulator: Embree has no memory for the ray-cast world");
  std::uninitialized_copy(data.begin(), data.end(), static_cast<Element*>(buffer));
}

RTCRay ray_along(const Point& origin, const Point& direction, float max_distance) {
  RTCRay ray{};
  ray.org_x = origin.x();
  ray.org_y = origin.y();
  ray.org_z = origin.z();
  ray.dir_x = direction.x();
  ray.dir_y = direction.y();
  ray.dir_z = direction.z();
  ray.tnear = 0.0F;
  ray.tfar = max_distance;
  ray.mask = ~0U;
  return ray;
}

}  // namespace

struct RayScene::Impl {
  explicit Impl(TriangleMesh triangles) : mesh(std::move(triangles)) {
    if (mesh.empty()) throw std::invalid_argument("simulator: a ray-cast body needs at least one triangle");
    device = rtcNewDevice("threads=1");
    if (device == nullptr)
      throw std::runtime_error("simulator: Embree finds no usable device on this processor");
    scene = rtcNewScene(device);
    rtcSetSceneFlags(scene, RTC_SCENE_FLAG_ROBUST);
    RTCGeometry geometry = rtcNewGeometry(device, RTC_GEOMETRY_TYPE_TRIANGLE);
    fill_buffer(geometry, RTC_BUFFER_TYPE_VERTEX, RTC_FORMAT_FLOAT3, mesh.vertices);
    fill_buffer(geometry, RTC_BUFFER_TYPE_INDEX, RTC_FORMAT_UINT3, mesh.triangles);
    rtcCommitGeometry(geometry);
    rtcAttachGeometry(scene, geometry);
    rtcReleaseGeometry(geometry);
    rtcCommitScene(scene);
  }
  ~Impl() {
    rtcReleaseScene(scene);
    rtcReleaseDevice(device);
  }
  Impl(const Impl&) = delete;
  Impl& operator=(const Impl&) = delete;

  TriangleMesh mesh;
  RTCDevice device = nullptr;
  RTCScene scene = nullptr;
};

RayScene::RayScene(TriangleMesh mesh) : impl_(std::make_unique<Impl>(std::move(mesh))) {}
RayScene::~RayScene() = default;
RayScene::RayScene(RayScene&&) noexcept = default;
RayScene& RayScene::operator=(RayScene&&) noexcept = default;

std::optional<RayHit> RayScene::cast(const Point& origin, const Point& direction, float max_distance) const {
  RTCIntersectContext context;
  rtcInitIntersectContext(&context);
  RTCRayHit query{};
  query.ray = ray_along(origin, direction, max_distance);
  query.hit.geomID = RTC_INVALID_GEOMETRY_ID;
  rtcIntersect1(impl_->scene, &context, &query);
  if (query.hit.geomID == RTC_INVALID_GEOMETRY_ID) return std::nullopt;
  const Point normal = Point(query.hit.Ng_x, query.hit.Ng_y, query.hit.Ng_z).normalized();
  const float cosine = std::abs(normal.dot(direction)) / direction.norm();
  return RayHit{query.ray.tfar, cosine, impl_->mesh.materials[query.hit.primID], normal};
}

bool RayScene::blocked(const Point& origin, const Point& direction, float max_distance) const {
  RTCIntersectContext context;
  rtcInitIntersectContext(&context);
  RTCRay ray = ray_along(origin, direction, max_distance);
  rtcOccluded1(impl_->scene, &context, &ray);
  return ray.tfar < 0.0F;
}

const TriangleMesh& RayScene::mesh() const { return impl_->mesh; }

}  // namespace hulltrack
