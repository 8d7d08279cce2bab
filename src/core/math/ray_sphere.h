// SPDX-License-Identifier: Apache-2.0
// The part of a ray inside a sphere.
#pragma once

#include "core/math/camera.h"

namespace cei3d {

// Distances along a ray. A ray that misses the sphere has near >= far.
template <class T>
struct SphereSpan {
  T near, far;
};

// Where a ray runs inside the sphere around the origin of that radius; near is 0 where the ray starts inside.
// direction: unit.
template <class T>
HD SphereSpan<T> sphere_span(Vec3<T> origin, Vec3<T> direction, T radius) {
  const T zero(0.0f), one(1.0f);
  const T b = dot(origin, direction), c = dot(origin, origin) - radius * radius, squared = b * b - c;
  const auto meets = squared > zero;
  const T root = sqrt(max(squared, zero));
  return {select(meets, max(-b - root, zero), one), select(meets, -b + root, zero)};
}
HD SphereSpan<float> sphere_span(const Ray& ray, float radius) {
  return sphere_span(ray.origin, ray.direction, radius);
}

}  // namespace cei3d
