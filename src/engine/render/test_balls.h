// SPDX-License-Identifier: Apache-2.0
// For tests of shading: meshes of balls, hits on them, lights and materials.
#pragma once

#include <cmath>

#include "core/math/rng.h"
#include "model/geometry/mesh/mesh.h"
#include "model/geometry/shape/hit.h"
#include "model/light/sg_mixture.h"
#include "model/material/material.h"

namespace cei3d {

inline void add_sphere(Mesh& m, Vec3f center, float radius, int n = 48) {
  const uint32_t first = uint32_t(m.positions.size());
  for (int i = 0; i <= n; ++i)
    for (int j = 0; j < 2 * n; ++j) {
      const float t = kPi * float(i) / float(n), p = kPi * float(j) / float(n);
      const Vec3f d{std::sin(t) * std::cos(p), std::sin(t) * std::sin(p), std::cos(t)};
      m.positions.push_back(center + d * radius);
      m.normals.push_back(d);
    }
  const auto at = [&](int i, int j) { return first + uint32_t(i * 2 * n + j % (2 * n)); };
  for (int i = 0; i < n; ++i)
    for (int j = 0; j < 2 * n; ++j) {
      m.triangles.push_back({at(i, j), at(i + 1, j), at(i + 1, j + 1)});
      m.triangles.push_back({at(i, j), at(i + 1, j + 1), at(i, j + 1)});
    }
}

// A ball of radius 0.5 at height lower_z and one of radius 0.3 at height 0.5, which touch or overlap.
inline Mesh two_spheres(float lower_z, int n = 48) {
  Mesh mesh;
  add_sphere(mesh, {0, 0, lower_z}, 0.5f, n);
  add_sphere(mesh, {0, 0, 0.5f}, 0.3f, n);
  return mesh;
}

// Hits in the middle of triangles, seen from random directions above them.
inline std::vector<Hit> some_hits(const Mesh& m, size_t n) {
  std::vector<Hit> hits;
  for (size_t i = 0; i < n; ++i) {
    Rng rng(3, 0, i);
    const uint32_t f = rng.below(uint32_t(m.triangles.size()));
    const auto& t = m.triangles[f];
    const Vec3f p = (m.positions[t[0]] + m.positions[t[1]] + m.positions[t[2]]) / 3.0f;
    const Vec3f normal = normalize(m.normals[t[0]] + m.normals[t[1]] + m.normals[t[2]]);
    Vec3f v = normalize(Vec3f{rng.normal(), rng.normal(), rng.normal()});
    if (dot(v, normal) < 0) v = -v;
    hits.push_back({p, normal, normalize(v + normal * 0.3f), f, 1.0f / 3, 1.0f / 3});
  }
  return hits;
}

inline SgMixture uniform_sky() {
  return {{{{0, 0, 1}, kBroadestLobe, {1, 1, 1}}, {{0, 0, -1}, kBroadestLobe, {1, 1, 1}}}};
}

inline SgMixture some_sky() {
  SgMixture light;
  for (uint64_t k = 0; k < 20; ++k) {
    Rng rng(9, 0, k);
    light.lobes.push_back({normalize(Vec3f{rng.normal(), rng.normal(), rng.normal()}),
                           1 + 60 * rng.uniform(),
                           {rng.uniform(), rng.uniform(), rng.uniform()}});
  }
  return light;
}

// What the surface is made of at a point.
struct MadeOf {
  Vec3f albedo;
  Material material;
};
inline constexpr MadeOf kCopper{{0.9f, 0.6f, 0.4f}, {0.3f, 0.5f, 1}},
    kClay{{0.6f, 0.4f, 0.3f}, {0.3f, 0.5f, 0}}, kGreenPaint{{0.1f, 0.7f, 0.2f}, {0.5f, 0.5f, 0}};

}  // namespace cei3d
