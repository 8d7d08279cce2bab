// SPDX-License-Identifier: Apache-2.0
#include "engine/render/self_reflection.h"

#include <algorithm>
#include <cmath>

#include "core/compute/kernels/shade.h"
#include "engine/render/hit_reflection.h"
#include "engine/render/lobe_frames.h"
#include "engine/render/lobe_rays.h"

namespace cei3d {
namespace {

constexpr float kMinCosine = 0.02f;  // minimum cosine of normal and view of a surface seen in a reflection

Vec3f unblocked(Vec3f blocked, Vec3f all) {
  const auto rest = [](float part, float whole) { return whole > 0 ? max(1 - part / whole, 0.0f) : 1.0f; };
  return {rest(blocked.x, all.x), rest(blocked.y, all.y), rest(blocked.z, all.z)};
}

}  // namespace

// Cache of the points of a lobe: neighboring hits mostly have the same number.
class SelfReflection::Points {
 public:
  const std::vector<Vec2f>& of(const Hit& h, const Material& m) {
    const int count = lobe_ray_count(m, dot(h.normal, h.to_camera));
    std::vector<Vec2f>& points = count == kMinLobeRays ? few_ : many_;
    if (int(points.size()) != count) points = lobe_points(count);
    return points;
  }

 private:
  std::vector<Vec2f> few_, many_;
};

// Rays of reflection lobes, without those that the visibility table shows to be unoccluded.
struct SelfReflection::Rays {
  std::vector<uint32_t> owner;  // the hit whose lobe each belongs to
  std::vector<float> share;     // of its lobe that each ray stands for
  std::vector<Vec3f> origins, directions;

  void reserve(size_t n) {
    owner.reserve(n);
    share.reserve(n);
    origins.reserve(n);
    directions.reserve(n);
  }
};

// Hits of lobe rays on the surface, seen from the origins of the rays.
struct SelfReflection::Met {
  std::vector<Hit> hits;
  std::vector<Material> materials;
  std::vector<Vec3f> albedo, irradiance;
  std::vector<size_t> ray;
  std::vector<uint32_t> owner;  // of the ray
};

SelfReflection::SelfReflection(const Device& device, const Surface& surface,
                               std::span<const VertexLight> vertices, LobePlanes light,
                               const DirectionMap& radiance, const VertexMaterials& seen)
    : device_(device),
      surface_(surface),
      vertices_(vertices),
      light_(light),
      radiance_(radiance),
      seen_(seen) {}

Material SelfReflection::material_at(const Surface::RayHit& r) const {
  const auto& t = surface_.mesh().triangles[r.triangle];
  const Material& first = seen_.material[t[0]];
  if (first == seen_.material[t[1]] && first == seen_.material[t[2]]) return first;  // without rounding
  return material_at_corners(seen_.material, t, r.b1, r.b2);
}

SelfReflection::Met SelfReflection::met_by(const Rays& rays, const TurnedHits& turned) const {
  std::vector<Surface::RayHit> far(rays.origins.size());
  surface_.intersect(rays.origins, rays.directions, 0, far);
  Met met;
  for (size_t k = 0; k < far.size(); ++k) {
    const Surface::RayHit& r = far[k];
    if (r.t < 0) continue;
    met.hits.push_back({rays.origins[k] + rays.directions[k] * r.t, normalize(at(surface_.mesh().normals, r)),
                        -rays.directions[k], r.triangle, r.b1, r.b2});
    met.materials.push_back(material_at(r));
    met.albedo.push_back(at(seen_.albedo, r));
    met.irradiance.push_back(at(vertices_[turned.bin(rays.owner[k])].irradiance, r));
    met.ray.push_back(k);
    met.owner.push_back(rays.owner[k]);
  }
  return met;
}

Vec3f SelfReflection::diffuse_radiance(const Surface::RayHit& r, size_t bin) const {
  return at(seen_.albedo, r) * at(vertices_[bin].irradiance, r) / kPi;
}

// Radiance along the axes of the reflection lobes of some of the points met: of the environment, or of the
// surface there, shaded as diffuse.
std::vector<Vec3f> SelfReflection::mirrored(const Met& met, const std::vector<size_t>& which,
                                            const TurnedHits& turned) const {
  const size_t n = which.size(), stride = size_t(padded_to_panels(int(n)));
  std::vector<Vec3f> from(n), axes(n), out(n);
  std::vector<float> sky(3 * stride);
  LobeFrames lobes{int(stride)};
  for (size_t k = 0; k < n; ++k) {
    const LobeFrame<float> lobe = reflection_of(met.hits[which[k]], met.materials[which[k]]).base;
    axes[k] = lobe.axis;
    from[k] = ray_origin(met.hits[which[k]]);
    lobes.put(k, in_room(turned, met.owner[which[k]], lobe));
  }
  device_.launch<SgReflection>({light_, int(stride), lobes.planes(), sky.data()}, int(stride));
  std::vector<Surface::RayHit> next(n);
  surface_.intersect(from, axes, 0, next);
  for (size_t k = 0; k < n; ++k)
    out[k] = next[k].t < 0 ? load_planes<float>(sky.data(), int(stride), int(k))
                           : diffuse_radiance(next[k], turned.bin(met.owner[which[k]]));
  return out;
}

// Radiance reflected by the points met. For dielectrics, which reflect little, the mean over all directions
// is used.
std::vector<Vec3f> SelfReflection::reflected_at(const Met& met, const TurnedHits& turned) const {
  std::vector<Vec3f> out(met.hits.size());
  std::vector<size_t> metals;
  for (size_t k = 0; k < out.size(); ++k) {
    out[k] = met.irradiance[k] / kPi;
    if (met.materials[k].metalness > 0) metals.push_back(k);
  }
  if (metals.empty()) return out;
  const std::vector<Vec3f> radiance = mirrored(met, metals, turned);
  for (size_t k = 0; k < metals.size(); ++k) out[metals[k]] = radiance[k];
  return out;
}

std::vector<Vec3f> SelfReflection::radiance_of(const Met& met, const TurnedHits& turned) const {
  std::vector<Vec3f> out = reflected_at(met, turned);
  for (size_t k = 0; k < out.size(); ++k) {
    const Material& m = met.materials[k];
    const float nv = max(dot(met.hits[k].normal, met.hits[k].to_camera), kMinCosine);
    const ShadingPoint<float> point{met.albedo[k],     m.roughness, m.specular,    m.metalness, nv,
                                    met.irradiance[k], out[k],      even_light(nv)};
    out[k] = shading_terms(split_sum_table(), point).radiance(point.albedo);
  }
  return out;
}

void SelfReflection::add_rays(const Hit& h, const Material& m, uint32_t owner,
                              const std::vector<Vec2f>& points, Rays& rays) const {
  const LobeRays lobe(h, m);
  for (const Vec2f& p : points) {
    const Vec3f ray = lobe.at(p);
    if (surface_.sees_around(h.triangle, ray)) continue;
    rays.owner.push_back(owner);
    rays.share.push_back(1 / float(points.size()));
    rays.origins.push_back(ray_origin(h));
    rays.directions.push_back(ray);
  }
}

// Mean radiance of the sky over the rays of a lobe, blocked or not.
Vec3f SelfReflection::sky_over(const HitBatch& batch, size_t hit, const std::vector<Vec2f>& points) const {
  const LobeRays lobe(batch.hits[hit], batch.materials[hit]);
  Vec3f sum{0, 0, 0};
  for (const Vec2f& p : points) sum += radiance_.at(batch.turned.in_room(hit, lobe.at(p)));
  return sum / float(points.size());
}

std::vector<SelfReflection::Reflected> SelfReflection::seen_by(const HitBatch& batch) const {
  const auto& [hits, materials, turned] = batch;
  Rays rays;
  rays.reserve(hits.size() * kMinLobeRays);
  Points points;
  for (size_t i = 0; i < hits.size(); ++i)
    add_rays(hits[i], materials[i], uint32_t(i), points.of(hits[i], materials[i]), rays);
  const Met met = met_by(rays, turned);
  const std::vector<Vec3f> radiance = radiance_of(met, turned);
  std::vector<Reflected> out(hits.size());
  std::vector<Vec3f> blocked(hits.size());  // radiance of the sky along rays that meet the surface
  for (size_t k = 0; k < met.hits.size(); ++k) {
    const size_t i = met.owner[k];
    const float share = rays.share[met.ray[k]];
    out[i].radiance += radiance[k] * share;
    blocked[i] += radiance_.at(turned.in_room(i, rays.directions[met.ray[k]])) * share;
  }
  for (size_t i = 0; i < hits.size(); ++i)
    if (dot(blocked[i], blocked[i]) > 0)
      out[i].visibility = unblocked(blocked[i], sky_over(batch, i, points.of(hits[i], materials[i])));
  return out;
}

}  // namespace cei3d
