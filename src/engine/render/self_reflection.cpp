// SPDX-License-Identifier: Apache-2.0
#include "engine/render/self_reflection.h"

#include <algorithm>
#include <cmath>

#include "core/compute/kernels/shade.h"
#include "core/math/brdf.h"
#include "engine/render/env_table.h"

namespace cei3d {
namespace {

constexpr float kLift = 2e-3f;  // rays start this far above the surface
// Rays of the reflection lobe of a material: the wider it is, the more. Metals show more of it than
// dielectrics, which have as few as there can be where they reflect less than kFaint.
constexpr float kMetalRays = 80, kDielectricRays = 28;  // by roughness
constexpr int kMostMetalRays = 24, kMostDielectricRays = 10, kLeastRays = 4;
constexpr float kFaint = 0.02f;
constexpr float kGrazing = 0.02f;  // least cosine of a reflection that another reflection sees

int lobe_rays(const Material& material) {
  const bool metal = material.metalness > 0;
  const float rays = material.roughness * (metal ? kMetalRays : kDielectricRays);
  return std::clamp(int(rays + 0.5f), kLeastRays, metal ? kMostMetalRays : kMostDielectricRays);
}

// Directions of equal weight that stand for the reflection lobe of a roughness around +Z: one ring at the
// radius that splits each equal share of its energy. 1 / (1 + x)^2 has the cumulative share x / (1 + x).
std::vector<Vec3f> lobe_directions(float roughness, int count) {
  std::vector<Vec3f> d;
  const float width = 2 / std::sqrt(reflection_scale(roughness));
  for (int k = 0; k < count; ++k) {
    const float u = (float(k) + 0.5f) / float(count);
    const float t = std::min(width * std::sqrt(u / (1 - u)), 1.4f), a = 2.399963f * float(k);
    d.push_back({std::sin(t) * std::cos(a), std::sin(t) * std::sin(a), std::cos(t)});
  }
  return d;
}

Vec3f turned(Vec3f z, Vec3f d) {  // d in a frame whose third axis is z
  const float s = z.z < 0 ? -1.0f : 1.0f, a = -1 / (s + z.z), b = z.x * z.y * a;  // [Duff et al. 2017]
  const Vec3f x{1 + s * z.x * z.x * a, s * b, -s * z.x}, y{b, s + z.y * z.y * a, -z.y};
  return x * d.x + y * d.y + z * d.z;
}

}  // namespace

SelfReflection::SelfReflection(const Device& device, const Surface& surface, const VertexLight& vertices,
                               LobePlanes light, const Material& material,
                               const std::vector<Vec2f>& env_table, std::span<const Vec3f> colors)
    : device_(device),
      surface_(surface),
      vertices_(vertices),
      light_(light),
      material_(material),
      roughness_(max(material.roughness, kLeastRoughness)),
      env_table_(env_table),
      colors_(colors),
      lobe_(lobe_directions(roughness_, lobe_rays(material))),
      faint_lobe_(lobe_directions(roughness_, kLeastRays)) {}

// A point that a ray met, looked at from where the ray began.
Hit SelfReflection::met_by(Vec3f origin, Vec3f direction, const Surface::RayHit& r) const {
  const Mesh& mesh = surface_.mesh();
  const Vec3f normal = normalize(at_corners(mesh.normals, mesh.triangles[r.triangle], r.b1, r.b2));
  return {origin + direction * r.t, normal, -direction, r.triangle, r.b1, r.b2};
}

// Radiance along the mirror directions of these points: of the sky, or of what is met there, as if that were
// diffuse.
std::vector<Vec3f> SelfReflection::mirrored(std::span<const Hit> met) const {
  const size_t n = met.size(), stride = (n + kPanel - 1) / kPanel * kPanel;
  std::vector<Vec3f> from(n), mirrors(n), out(n);
  std::vector<float> mirror_planes(3 * stride, 0.0f), sky(3 * stride);
  for (size_t k = 0; k < n; ++k) {
    mirrors[k] = mirror_direction(met[k]);
    from[k] = met[k].position + met[k].normal * kLift;
    for (int c = 0; c < 3; ++c) mirror_planes[size_t(c) * stride + k] = mirrors[k][c];
  }
  SgReflection::Args args{light_, {}, {}, int(stride), mirror_planes.data(), sky.data()};
  set_reflection_lobe(roughness_, args);
  device_.launch<SgReflection>(args, int(stride));
  std::vector<Surface::RayHit> next(n);
  surface_.intersect(from, mirrors, 0, next);
  for (size_t k = 0; k < n; ++k)
    out[k] = next[k].t < 0 ? Vec3f{sky[k], sky[stride + k], sky[2 * stride + k]}
                           : at(colors_, next[k]) * at(vertices_.arriving, next[k]);
  return out;
}

// Radiance that leaves these points for where they are looked at from. Dielectrics reflect little of what
// arrives there, so in another reflection its mean over all directions does.
std::vector<Vec3f> SelfReflection::shown(std::span<const Hit> met) const {
  const float m = material_.metalness, dielectric = (1 - m) * kDielectricF0 * material_.specular;
  std::vector<Vec3f> out = m > 0 ? mirrored(met) : std::vector<Vec3f>();
  out.resize(met.size());
  for (size_t k = 0; k < met.size(); ++k) {
    const Vec3f color = at(colors_, met[k]), arriving = at(vertices_.arriving, met[k]);
    const Vec3f reflected = m > 0 ? out[k] : arriving;
    const Vec2f env = env_brdf_at(env_table_, max(dot(met[k].normal, met[k].to_camera), kGrazing));
    for (int c = 0; c < 3; ++c)
      out[k][c] =
          (1 - m) * color[c] * arriving[c] + ((m * color[c] + dielectric) * env.x + env.y) * reflected[c];
  }
  return out;
}

// Rays of reflection lobes, but those that nothing can be in the way of.
struct SelfReflection::Rays {
  std::vector<uint32_t> owner;  // the hit that each is of
  std::vector<float> share;     // of its lobe
  std::vector<Vec3f> origins, directions;

  void reserve(size_t n) {
    owner.reserve(n);
    share.reserve(n);
    origins.reserve(n);
    directions.reserve(n);
  }
};

bool SelfReflection::faint(const Hit& h) const {
  if (material_.metalness > 0) return false;
  const Vec2f env = env_brdf_at(env_table_, dot(h.normal, h.to_camera));
  return kDielectricF0 * material_.specular * env.x + env.y < kFaint;
}

void SelfReflection::add_lobe(const Hit& h, uint32_t owner, Rays& rays) const {
  const std::vector<Vec3f>& lobe = faint(h) ? faint_lobe_ : lobe_;
  const Vec3f r = mirror_direction(h);
  for (const Vec3f& d : lobe) {
    Vec3f ray = turned(r, d);
    // Below the horizon: folded up, since masking is in the reflectance already.
    ray = ray - h.normal * (2 * min(dot(ray, h.normal), 0.0f));
    if (surface_.open(h.triangle, ray)) continue;
    rays.owner.push_back(owner);
    rays.share.push_back(1 / float(lobe.size()));
    rays.origins.push_back(h.position + h.normal * kLift);
    rays.directions.push_back(ray);
  }
}

std::vector<SelfReflection::Seen> SelfReflection::seen_by(std::span<const Hit> hits) const {
  Rays rays;
  rays.reserve(hits.size() * lobe_.size());
  for (size_t i = 0; i < hits.size(); ++i) add_lobe(hits[i], uint32_t(i), rays);
  std::vector<Surface::RayHit> far(rays.origins.size());
  surface_.intersect(rays.origins, rays.directions, 0, far);
  std::vector<Hit> met;
  std::vector<size_t> along;  // which ray each was met by
  for (size_t k = 0; k < far.size(); ++k)
    if (far[k].t >= 0) {
      met.push_back(met_by(rays.origins[k], rays.directions[k], far[k]));
      along.push_back(k);
    }
  const std::vector<Vec3f> radiance = shown(met);
  std::vector<Seen> out(hits.size());
  for (size_t k = 0; k < met.size(); ++k) {
    Seen& seen = out[rays.owner[along[k]]];
    seen.open -= rays.share[along[k]];
    seen.radiance += radiance[k] * rays.share[along[k]];
  }
  return out;
}

}  // namespace cei3d
