// SPDX-License-Identifier: Apache-2.0
// Quadrature over the facets of a GGX surface that reflect towards a viewer.
#pragma once

#include "core/math/brdf.h"
#include "core/math/mirror.h"

namespace cei3d {

// Squared cosine of a facet and the normal: for u uniform in [0, 1), facets are drawn with the density of
// GGX, by projected area. [Walter et al. 2007]
template <class T>
HD T ggx_facet_cosine2(T u, T alpha) {
  return (T(1.0f) - u) / (T(1.0f) + (alpha * alpha - T(1.0f)) * u);
}

// Calls visit(weight, direction of the light, cosine of facet and viewer). The sum of weight times Fresnel
// term is the fraction of uniform light that the surface reflects towards the viewer; over directions, the
// weights are distributed like the reflected light. Frame: the normal is (0, 0, 1), the viewer is at cosine
// nv in (0, 1], with y = 0; directions with y < 0 mirror those that are visited.
//
// Facets are drawn with the density of GGX. The integrand is steep near u = 1, so the nodes are dense there:
// u = 1 - (1 - t)^3. Error of the sums: below 1e-3, mostly below 5e-4.
template <class F>
void for_reflections(double nv, double roughness, const F& visit) {
  constexpr int kRings = 40, kSteps = 16;  // steps: on half a turn
  const double alpha = roughness * roughness;
  const Vec3d v{std::sqrt(1 - nv * nv), 0, nv};
  for (int i = 0; i < kRings; ++i) {
    const double rest = 1 - (i + 0.5) / kRings, u = 1 - rest * rest * rest, weight = 3 * rest * rest;
    const double c = std::sqrt(ggx_facet_cosine2(u, alpha)), s = std::sqrt(1 - c * c);
    for (int j = 0; j < kSteps; ++j) {
      const double a = M_PI * (j + 0.5) / kSteps;
      const Vec3d h{s * std::cos(a), s * std::sin(a), c};
      const double vh = dot(v, h);
      const Vec3d l = mirrored(h, v);
      if (vh <= 0 || l.z <= 0) continue;
      visit(weight * smith_g1(nv, alpha) * smith_g1(l.z, alpha) * vh / (c * nv * kRings * kSteps), l, vh);
    }
  }
}

}  // namespace cei3d
