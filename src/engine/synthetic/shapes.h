// SPDX-License-Identifier: Apache-2.0
// The bodies that `cei3d synth` knows, z up, each divided into regions with analytic borders.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "engine/synthetic/body.h"

namespace cei3d {

struct BallDistance {
  float radius = 0.9f;
  template <class T>
  T operator()(Vec3<T> p) const {
    return length(p) - T(radius);
  }
};

// Axis-parallel, with rounded edges.
struct BoxDistance {
  Vec3f half{0.55f, 0.55f, 0.42f};  // half of the edges
  float rounding = 0.04f;           // radius of the edges
  template <class T>
  T operator()(Vec3<T> p) const {
    Vec3<T> outside;
    T inside(-1.0f);
    for (int k = 0; k < 3; ++k) {
      const T q = abs(p[k]) - T(half[k] - rounding);
      outside[k] = max(q, T(0.0f));
      inside = max(inside, q);
    }
    return sqrt(dot(outside, outside) + T(1e-14f)) + min(inside, T(0.0f)) - T(rounding);
  }
};

struct Shape {
  std::string name;
  std::shared_ptr<const Body> body;
  std::vector<std::string> regions;  // "body", "band", "lid", ...
  size_t (*region_at)(Vec3f p);      // of a point on the surface: index into regions
};

Shape ball_shape(float radius = BallDistance{}.radius);
Shape box_shape();
Shape teapot_shape();

std::vector<std::string> shape_names();
Shape shape_by_name(const std::string& name);  // usage error: unknown; the names are listed

}  // namespace cei3d
