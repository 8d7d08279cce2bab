// SPDX-License-Identifier: Apache-2.0
#include "engine/synthetic/path_tracer.h"

namespace cei3d {
namespace {

constexpr float kLift = 1e-3f;  // rays leave the surface from this far above it, unit frame

Ray leaving(const BodyPoint& p, Vec3f direction) { return {p.position + p.normal * kLift, direction}; }

// Weight of one of two sampling strategies in a combined estimate. [Veach 1997, balance heuristic]
float share(float density, float other) { return density / (density + other); }

}  // namespace

BodyPoint body_point(const SyntheticScene& scene, Vec3f position) {
  const Finish& f = scene.finishes[scene.shape.region_at(position)];
  return {position, scene.shape.body->normal(position), f.material, albedo_at(f, position)};
}

// Estimate by a direction sampled from the light.
Vec3f PathTracer::direct(const BodyPoint& p, const Scattering& s, float pick, Vec2<float> u) const {
  const Vec3f l = light_.sample(pick, u);
  if (dot(l, p.normal) <= 0 || scene_.shape.body->passes_within(leaving(p, l), 0)) return {0, 0, 0};
  const LightSampler::Value light = light_.at(l);
  return s.reflected(l) * light.radiance * (share(light.density, s.density(l)) / light.density);
}

Vec3f PathTracer::radiance(BodyPoint p, Vec3f to_viewer, SampleSequence& samples) const {
  Vec3f sum{0, 0, 0}, weight{1, 1, 1};
  for (int bounce = 0;; ++bounce) {
    const Scattering s(p.normal, to_viewer, p.material, p.albedo, scene_.diffuse);
    const Vec2<float> picks = samples.pair(), to_lamp = samples.pair(), onward = samples.pair();
    sum += weight * direct(p, s, picks.x, to_lamp);
    const Vec3f l = s.sample(picks.y, onward);
    const float density = s.density(l);
    if (dot(l, p.normal) <= 0 || density <= 0) return sum;
    weight = weight * s.reflected(l) / density;
    const Ray ray = leaving(p, l);
    const float t = scene_.shape.body->cast(ray);
    if (t < 0) {
      const LightSampler::Value light = light_.at(l);
      return sum + weight * light.radiance * share(density, light.density);
    }
    if (bounce == scene_.bounces) return sum;
    p = body_point(scene_, ray.origin + l * t);
    to_viewer = -l;
  }
}

}  // namespace cei3d
