// SPDX-License-Identifier: Apache-2.0
// Closed bodies as analytic signed distances. Rays meet them by sphere tracing: a step along the ray may be
// as long as the distance to the surface. [Hart 1996]
#pragma once

#include "core/math/camera.h"
#include "core/math/dual.h"

namespace cei3d {

// A closed body inside the unit sphere around the origin.
class Body {
 public:
  virtual ~Body() = default;
  // Negative inside; outside at most the distance to the surface.
  virtual float distance(Vec3f p) const = 0;
  virtual Vec3f normal(Vec3f p) const = 0;  // unit, outward: the gradient of the distance
  // Distance along the ray to the surface, exact to about 1e-6 (to kTouch where the ray grazes it); negative:
  // the ray misses. The origin lies outside.
  virtual float cast(const Ray& ray) const = 0;
  // Whether the ray comes nearer to the surface than `radius`.
  virtual bool passes_within(const Ray& ray, float radius) const = 0;
};

// Distance to the surface at which a ray counts as a hit, unit frame.
inline constexpr float kTouch = 1e-4f;

// Distance along the ray to the first point nearer to the surface than radius + kTouch; negative: there is
// none.
template <class Distance>
float march(const Distance& distance, const Ray& ray, float radius) {
  constexpr int kMaxSteps = 400;  // used up only by rays that graze the surface for long
  const float reach = 1 + radius;
  const float b = dot(ray.origin, ray.direction);
  const float root = b * b - dot(ray.origin, ray.origin) + reach * reach;
  if (root <= 0) return -1;
  const float end = sqrt(root) - b;
  float t = max(-sqrt(root) - b, 0.0f);
  for (int step = 0; step < kMaxSteps && t < end; ++step) {
    const float gap = distance(ray.origin + ray.direction * t) - radius;
    if (gap < kTouch) return t;
    t += gap;
  }
  return -1;
}

// A body made of a signed distance: a functor that maps Vec3<T> to T for float and dual numbers.
template <class Distance>
class SdfBody final : public Body {
 public:
  explicit SdfBody(Distance distance) : distance_(distance) {}

  float distance(Vec3f p) const override { return distance_(p); }
  Vec3f normal(Vec3f p) const override {
    Vec3f gradient;
    for (int k = 0; k < 3; ++k) {
      Vec3<Dual<float>> q{Dual<float>(p.x), Dual<float>(p.y), Dual<float>(p.z)};
      q[k].derivative = 1;
      gradient[k] = distance_(q).derivative;
    }
    return normalize(gradient);
  }
  float cast(const Ray& ray) const override {
    const float t = march(distance_, ray, 0);
    return t < 0 ? t : refined(ray, t);
  }
  bool passes_within(const Ray& ray, float radius) const override {
    return march(distance_, ray, radius) >= 0;
  }

 private:
  // One more step, then one of the secant method.
  float refined(const Ray& ray, float t) const {
    const float d0 = distance_(ray.origin + ray.direction * t);
    if (abs(d0) < 2e-6f) return t;
    const float d1 = distance_(ray.origin + ray.direction * (t + d0)), slope = (d1 - d0) / d0;
    return t + d0 - (slope < -0.05f ? d1 / slope : 0.0f);
  }

  Distance distance_;
};

}  // namespace cei3d
