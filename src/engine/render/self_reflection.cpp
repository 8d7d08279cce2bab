// SPDX-License-Identifier: Apache-2.0
#include "engine/render/self_reflection.h"

#include <algorithm>
#include <cmath>

#include "core/compute/kernels/shade.h"
#include "engine/render/hit_reflection.h"
#include "engine/render/lobe_frames.h"

namespace cei3d {
namespace {

// Rays of a reflection lobe: in proportion to its roughness, more for metals, whose reflections are stronger.
// A dielectric that reflects less than kFaint towards the viewer gets the fewest.
constexpr float kMetalRays = 80, kDielectricRays = 28;  // number of rays per unit of roughness
constexpr int kMaxMetalRays = 24, kMaxDielectricRays = 10, kMinRays = 4;
constexpr float kFaint = 0.02f;
constexpr float kMinCosine = 0.02f;  // of a surface seen in a reflection

int lobe_rays(const Material& m, float nv) {
  const bool metal = m.metalness > 0;
  if (!metal) {
    const SplitSum<float> s = split_sum(split_sum_table(), nv, m.roughness);
    if (dielectric_f0(m.specular, m.metalness) * s.scale + s.bias < kFaint) return kMinRays;
  }
  const float rays = m.roughness * (metal ? kMetalRays : kDielectricRays);
  return std::clamp(int(rays + 0.5f), kMinRays, metal ? kMaxMetalRays : kMaxDielectricRays);
}

// `count` directions of equal weight for the reflection lobe of a roughness around +Z: each at the radius
// that halves its share of the energy. The lobe 1 / (1 + x)^2 has the cumulative share x / (1 + x).
std::vector<Vec3f> lobe_directions(float roughness, int count) {
  std::vector<Vec3f> d;
  const float width = 2 / std::sqrt(reflection_scale(max(roughness, kMinRoughness)));
  for (int k = 0; k < count; ++k) {
    const float u = (float(k) + 0.5f) / float(count);
    const float t = std::min(width * std::sqrt(u / (1 - u)), 1.4f), a = 2.399963f * float(k);
    d.push_back({std::sin(t) * std::cos(a), std::sin(t) * std::sin(a), std::cos(t)});
  }
  return d;
}

// d in a frame whose third axis is z. [Duff et al. 2017]
Vec3f turned(Vec3f z, Vec3f d) {
  const float s = z.z < 0 ? -1.0f : 1.0f, a = -1 / (s + z.z), b = z.x * z.y * a;
  const Vec3f x{1 + s * z.x * z.x * a, s * b, -s * z.x}, y{b, s + z.y * z.y * a, -z.y};
  return x * d.x + y * d.y + z * d.z;
}

}  // namespace

// Cache of lobe directions: neighboring hits mostly have the same lobe.
class SelfReflection::Lobes {
 public:
  const std::vector<Vec3f>& of(const Material& m, float nv) {
    const int count = lobe_rays(m, nv);
    Entry& e = count == kMinRays ? few_ : many_;
    if (int(e.directions.size()) != count || e.roughness != m.roughness)
      e = {m.roughness, lobe_directions(m.roughness, count)};
    return e.directions;
  }

 private:
  struct Entry {
    float roughness = -1;
    std::vector<Vec3f> directions;
  };
  Entry few_, many_;
};

// Rays of reflection lobes, without those that the visibility table shows to be unoccluded.
struct SelfReflection::Rays {
  std::vector<uint32_t> owner;  // the hit whose lobe each belongs to
  std::vector<float> share;     // of that lobe
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
                               const VertexMaterials& seen)
    : device_(device), surface_(surface), vertices_(vertices), light_(light), seen_(seen) {}

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
    const ShadingPoint<float> point{met.albedo[k],     m.roughness, m.specular, m.metalness, nv,
                                    met.irradiance[k], out[k]};
    out[k] = shading_terms(split_sum_table(), point).radiance(point.albedo);
  }
  return out;
}

void SelfReflection::add_rays(const Hit& h, const Material& m, uint32_t owner, const std::vector<Vec3f>& lobe,
                              Rays& rays) const {
  const Vec3f r = mean_axis(reflection_of(h, m));
  for (const Vec3f& d : lobe) {
    Vec3f ray = turned(r, d);
    // Folded up from below the horizon: the split sum already holds the masking.
    ray = ray - h.normal * (2 * min(dot(ray, h.normal), 0.0f));
    if (surface_.open(h.triangle, ray)) continue;
    rays.owner.push_back(owner);
    rays.share.push_back(1 / float(lobe.size()));
    rays.origins.push_back(ray_origin(h));
    rays.directions.push_back(ray);
  }
}

std::vector<SelfReflection::Seen> SelfReflection::seen_by(const HitBatch& batch) const {
  const auto& [hits, materials, turned] = batch;
  Rays rays;
  rays.reserve(hits.size() * kMinRays);
  Lobes lobes;
  for (size_t i = 0; i < hits.size(); ++i)
    add_rays(hits[i], materials[i], uint32_t(i),
             lobes.of(materials[i], dot(hits[i].normal, hits[i].to_camera)), rays);
  const Met met = met_by(rays, turned);
  const std::vector<Vec3f> radiance = radiance_of(met, turned);
  std::vector<Seen> out(hits.size());
  for (size_t k = 0; k < met.hits.size(); ++k) {
    Seen& seen = out[met.owner[k]];
    const float share = rays.share[met.ray[k]];
    seen.visibility -= share;
    seen.radiance += radiance[k] * share;
  }
  return out;
}

}  // namespace cei3d
