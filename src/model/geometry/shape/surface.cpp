// SPDX-License-Identifier: Apache-2.0
// The only file that uses Embree (version 3 or 4).
#include "model/geometry/shape/surface.h"

#if __has_include(<embree4/rtcore.h>)
#include <embree4/rtcore.h>
#else
#include <embree3/rtcore.h>
#endif

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <type_traits>

#include "core/base/cancel.h"
#include "core/base/error.h"
#include "core/base/parallel.h"

namespace cei3d {
namespace {

constexpr int kRowBytes = kSkyDirections / 8;

// Normals for a mesh without any: face normals weighted by their angle at the vertex. [Thuermer and Wuethrich
// 1998]
std::vector<Vec3f> angle_weighted_normals(const Mesh& mesh) {
  std::vector<Vec3f> sum(mesh.positions.size(), Vec3f{0, 0, 0});
  for (const auto& t : mesh.triangles)
    for (int c = 0; c < 3; ++c) {
      const Vec3f p = mesh.positions[t[c]];
      const Vec3f a = mesh.positions[t[(c + 1) % 3]] - p, b = mesh.positions[t[(c + 2) % 3]] - p;
      const Vec3f n = cross(a, b);
      const float flat = 1e-5f * max(dot(a, a), dot(b, b));
      if (length(n) <= flat) continue;  // a sliver has no normal of its own
      sum[t[c]] += normalize(n) * std::acos(clamp(dot(normalize(a), normalize(b)), -1.0f, 1.0f));
    }
  for (Vec3f& n : sum) n = normalize(n);
  return sum;
}

void check_mesh(const Mesh& mesh) {
  const size_t n = mesh.positions.size();
  for (const auto& t : mesh.triangles)
    if (std::max({t[0], t[1], t[2]}) >= n)
      fail("A triangle of the mesh names vertex {} of {}.", std::max({t[0], t[1], t[2]}), n);
  if (!mesh.normals.empty() && mesh.normals.size() != n)
    fail("A mesh has {} normals for {} vertices (an error in the program).", mesh.normals.size(), n);
}

RTCRay make_ray(Vec3f o, Vec3f d, float t_min) {
  RTCRay r{};
  r.org_x = o.x, r.org_y = o.y, r.org_z = o.z;
  r.dir_x = d.x, r.dir_y = d.y, r.dir_z = d.z;
  r.tnear = t_min;
  r.tfar = std::numeric_limits<float>::infinity();
  r.mask = ~0u;
  return r;
}

// Owns an Embree handle.
struct Release {
  void operator()(RTCDevice d) const { rtcReleaseDevice(d); }
  void operator()(RTCScene s) const { rtcReleaseScene(s); }
  void operator()(RTCGeometry g) const { rtcReleaseGeometry(g); }
};
template <class Handle>
using Owned = std::unique_ptr<std::remove_pointer_t<Handle>, Release>;

std::shared_ptr<std::remove_pointer_t<RTCDevice>> new_device() {
  const RTCDevice device = rtcNewDevice(nullptr);
  if (!device) fail("The ray index (Embree) could not start on this processor.");
  return {device, Release()};
}

}  // namespace

struct Surface::Bvh {
  std::shared_ptr<std::remove_pointer_t<RTCDevice>> device;
  Owned<RTCScene> owned_scene;
  RTCScene scene;

  // before: of the shape before, whose device is used; null: a new one.
  Bvh(const Mesh& mesh, const Bvh* before)
      : device(before ? before->device : new_device()),
        owned_scene(rtcNewScene(device.get())),
        scene(owned_scene.get()) {
    rtcSetSceneFlags(scene, RTC_SCENE_FLAG_ROBUST);
    if (!mesh.triangles.empty()) add(mesh);
    rtcCommitScene(scene);
    if (rtcGetDeviceError(device.get()) != RTC_ERROR_NONE)
      fail("The ray index of a mesh of {} triangles could not be made.", mesh.triangles.size());
  }

  void add(const Mesh& mesh) {
    const Owned<RTCGeometry> owned(rtcNewGeometry(device.get(), RTC_GEOMETRY_TYPE_TRIANGLE));
    const RTCGeometry g = owned.get();
    // Embree reads 4 bytes past the last vertex of a shared buffer, so it gets its own copy.
    auto* p = static_cast<float*>(rtcSetNewGeometryBuffer(g, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3,
                                                          sizeof(Vec3f), mesh.positions.size()));
    auto* t = static_cast<uint32_t*>(rtcSetNewGeometryBuffer(g, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3,
                                                             3 * sizeof(uint32_t), mesh.triangles.size()));
    if (!p || !t)
      fail("There is not enough memory for the ray index of a mesh of {} triangles.", mesh.triangles.size());
    for (const Vec3f& v : mesh.positions) *p++ = v.x, *p++ = v.y, *p++ = v.z;
    for (const auto& tri : mesh.triangles) t = std::copy(tri.begin(), tri.end(), t);
    rtcCommitGeometry(g);
    rtcAttachGeometry(scene, g);
  }

  bool blocked(Vec3f o, Vec3f d) const {
    RTCRay r = make_ray(o, d, 0);
#if RTC_VERSION_MAJOR >= 4
    rtcOccluded1(scene, &r, nullptr);
#else
    RTCIntersectContext context;
    rtcInitIntersectContext(&context);
    rtcOccluded1(scene, &context, &r);
#endif
    return r.tfar < 0;
  }

  RayHit closest(Vec3f o, Vec3f d, float t_min) const {
    RTCRayHit h{};
    h.ray = make_ray(o, d, t_min);
    h.hit.geomID = RTC_INVALID_GEOMETRY_ID;
#if RTC_VERSION_MAJOR >= 4
    rtcIntersect1(scene, &h, nullptr);
#else
    RTCIntersectContext context;
    rtcInitIntersectContext(&context);
    rtcIntersect1(scene, &context, &h);
#endif
    if (h.hit.geomID == RTC_INVALID_GEOMETRY_ID) return {};
    return {h.ray.tfar, h.hit.primID, h.hit.u, h.hit.v};  // p = (1 - u - v) v0 + u v1 + v v2
  }

  // Writes the visibility of the vertices with recast[v] = 1; recast empty: of all. Error: interrupted.
  void cast_visibility(const Mesh& mesh, std::span<const uint8_t> recast, std::vector<uint8_t>& bits,
                       const Progress& progress) const {
    constexpr int kSlab = 1 << 14;  // vertices between two checks: 1 to 4 s of one core
    const int n = int(mesh.positions.size());
    for (int first = 0; first < n; first += kSlab) {
      check_cancelled(progress);
      parallel_ranges(std::min(kSlab, n - first), 64, [&](int begin, int end) {
        for (int v = first + begin; v < first + end; ++v)
          if (recast.empty() || recast[v]) cast_row(mesh, v, &bits[size_t(v) * kRowBytes]);
      });
    }
  }

  void cast_row(const Mesh& mesh, int vertex, uint8_t* row) const {
    const std::vector<Vec3f>& sky = sky_directions();
    const Vec3f n = mesh.normals[vertex], o = mesh.positions[vertex] + n * kRayLift;
    std::fill(row, row + kRowBytes, uint8_t(0));
    for (int k = 0; k < kSkyDirections; ++k)
      if (dot(sky[k], n) > 0 && !blocked(o, sky[k])) row[k / 8] |= uint8_t(1 << k % 8);
  }
};

Surface::Surface(Mesh mesh, const Progress& progress) : mesh_(std::move(mesh)) {
  check_mesh(mesh_);
  if (mesh_.normals.empty()) mesh_.normals = angle_weighted_normals(mesh_);
  bvh_ = std::make_unique<Bvh>(mesh_, nullptr);
  visibility_.resize(mesh_.positions.size() * kRowBytes);
  bvh_->cast_visibility(mesh_, {}, visibility_, progress);
}

Surface::Surface(Mesh mesh, std::vector<uint8_t> visibility)
    : mesh_(std::move(mesh)), visibility_(std::move(visibility)) {
  check_mesh(mesh_);
  if (mesh_.normals.empty()) mesh_.normals = angle_weighted_normals(mesh_);
  if (visibility_.size() != mesh_.positions.size() * kRowBytes)
    fail("A visibility table of {} bytes does not fit a mesh of {} vertices.", visibility_.size(),
         mesh_.positions.size());
  bvh_ = std::make_unique<Bvh>(mesh_, nullptr);
}

Surface::Surface(Mesh mesh, const Surface& before, std::span<const uint8_t> recast)
    : mesh_(std::move(mesh)), visibility_(before.visibility_) {
  check_mesh(mesh_);
  if (recast.size() != mesh_.positions.size() || mesh_.normals.empty())
    fail("A change of the surface needs normals and {} marks, not {} (an error in the program).",
         mesh_.positions.size(), recast.size());
  bvh_ = std::make_unique<Bvh>(mesh_, before.bvh_.get());
  visibility_.resize(mesh_.positions.size() * kRowBytes);
  bvh_->cast_visibility(mesh_, recast, visibility_, Progress());
}

Surface::~Surface() = default;

bool Surface::sees_around(uint32_t triangle, Vec3f direction) const {
  for (const uint16_t k : sky_around(direction))
    for (const uint32_t corner : mesh_.triangles[triangle])
      if (!sees(corner, k)) return false;
  return true;
}

void Surface::intersect(std::span<const Vec3f> origins, std::span<const Vec3f> directions, float t_min,
                        std::span<RayHit> out) const {
  parallel_ranges(int(origins.size()), 1024, [&](int begin, int end) {
    for (int i = begin; i < end; ++i) out[i] = bvh_->closest(origins[i], directions[i], t_min);
  });
}

}  // namespace cei3d
