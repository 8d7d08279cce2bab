// SPDX-License-Identifier: Apache-2.0
// A teapot-like body: a squat body of revolution, a domed lid with a knob, a curved spout on the side of +x
// and a ring for a handle on the other. Rim, handle and spout are reflected in the body, and it in them.
#pragma once

#include "core/math/vec.h"

namespace cei3d {

struct TeapotDistance {
  // The smaller of two distances with a fillet of width k between them: a gradient of at most unit length.
  template <class T>
  static T blend(T a, T b, float k) {
    const T h = max(T(k) - abs(a - b), T(0.0f));
    return min(a, b) - h * h * T(0.25f / k);
  }
  template <class T>
  static T from_axis(Vec3<T> p) {
    return sqrt(p.x * p.x + p.y * p.y + T(1e-12f));  // smooth on the axis, too
  }
  template <class T>
  static T ball(Vec3<T> p, float z, float radius) {
    return length(p - Vec3<T>{T(0.0f), T(0.0f), T(z)}) - T(radius);
  }
  // A ring around the z axis, at height z.
  template <class T>
  static T ring(T r, T z, float height, float major, float minor) {
    const T a = r - T(major), b = z - T(height);
    return sqrt(a * a + b * b + T(1e-14f)) - T(minor);
  }
  // A straight tube whose radius goes from ra at `a` to rb at `b`, in the plane y = 0.
  template <class T>
  static T tube(Vec3<T> p, Vec3f a, Vec3f b, float ra, float rb) {
    const Vec3f edge = b - a;
    const Vec3<T> from_a = p - Vec3<T>{T(a.x), T(a.y), T(a.z)}, e{T(edge.x), T(edge.y), T(edge.z)};
    const T h = clamp(dot(from_a, e) / T(dot(edge, edge)), T(0.0f), T(1.0f));
    const float slope = (rb - ra) / length(edge);
    // The gradient is as long as the cone is steep.
    return (length(from_a - e * h) - (T(ra) + h * T(rb - ra))) * T(1 / std::sqrt(1 + slope * slope));
  }

  // The parts, which define the regions.
  template <class T>
  static T belly(Vec3<T> p) {
    const T flat = max(from_axis(p) - T(0.22f), T(0.0f)), z = p.z + T(0.08f);
    const T pill = sqrt(flat * flat + z * z + T(1e-14f)) - T(0.36f);
    return max(pill, T(-0.38f) - p.z);  // stands on a flat bottom
  }
  template <class T>
  static T lid(Vec3<T> p) {
    return min(blend(ball(p, 0.18f, 0.27f), ball(p, 0.5f, 0.075f), 0.05f),
               ring(from_axis(p), p.z, 0.29f, 0.25f, 0.03f));
  }
  template <class T>
  static T handle(Vec3<T> p) {
    const T x = p.x + T(0.6f), z = p.z + T(0.02f), y = p.y;
    const T around = sqrt(x * x + z * z + T(1e-12f)) - T(0.24f);
    return sqrt(around * around + y * y + T(1e-14f)) - T(0.05f);
  }
  template <class T>
  static T spout(Vec3<T> p) {
    const Vec3f root{0.45f, 0, -0.2f}, bend{0.72f, 0, 0.04f}, tip{0.85f, 0, 0.28f};
    return blend(tube(p, root, bend, 0.15f, 0.085f), tube(p, bend, tip, 0.085f, 0.055f), 0.03f);
  }

  template <class T>
  T operator()(Vec3<T> p) const {
    return min(min(blend(belly(p), spout(p), 0.06f), lid(p)), handle(p));
  }
};

}  // namespace cei3d
