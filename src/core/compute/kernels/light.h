// SPDX-License-Identifier: Apache-2.0
// Fit of spherical Gaussians to radiance on a set of directions ("cells"): squared error of square roots, so
// that a sun does not drown the sky.
#pragma once

#include "core/compute/kernel.h"
#include "core/compute/kernels/lobes.h"

namespace cei3d {

struct SgFitArgs {
  LobePlanes lobes;
  int cells;                // padded to 32; padding has zero weight
  const float* directions;  // [3][cells] unit
  const float* roots;       // [3][cells] square root of the radiance
  const float* weights;     // [cells] steradians
  float* d_radiance;        // [3][cells] dL/d(radiance)
  float* d_lobes;           // [7][padded] dL/d(axis, lambda, color)
};

// Item: a cell. Evaluates the mixture and writes d_radiance.
struct SgFitResidual {
  using Args = SgFitArgs;
  template <class T>
  static HD void run(const Args& a, int i) {
    const Vec3<T> d = load_planes<T>(a.directions, a.cells, i), target = load_planes<T>(a.roots, a.cells, i);
    Vec3<T> sum{T(0.0f), T(0.0f), T(0.0f)};
    for (int k = 0; k < a.lobes.count; ++k)
      sum += a.lobes.mu<T>(k) * exp(a.lobes.lambda<T>(k) * (dot(d, a.lobes.axis<T>(k)) - T(1.0f)));
    Vec3<T> g;
    const T w = load<T>(a.weights + i);
    for (int c = 0; c < 3; ++c) {
      const T root = sqrt(sum[c] + T(1e-4f));
      g[c] = w * (root - target[c]) / root;
    }
    store_planes(a.d_radiance, a.cells, i, g);
  }
};

// Item: a lobe. Gathers its gradient from all cells.
struct SgFitGather {
  using Args = SgFitArgs;
  template <class T>
  static HD void run(const Args& a, int i) {
    const int p = a.lobes.padded;
    const Vec3<T> axis = load_planes<T>(a.lobes.data, p, i), mu = load_planes<T>(a.lobes.data + 4 * p, p, i);
    const T lambda = load<T>(a.lobes.data + 3 * p + i), zero(0.0f);
    Vec3<T> d_axis{zero, zero, zero}, d_mu{zero, zero, zero};
    T d_lambda = zero;
    for (int c = 0; c < a.cells; ++c) {
      const float *q = a.directions + c, *r = a.d_radiance + c;
      const Vec3<T> d{T(q[0]), T(q[a.cells]), T(q[2 * a.cells])},
          g{T(r[0]), T(r[a.cells]), T(r[2 * a.cells])};
      const T t = dot(d, axis) - T(1.0f), e = exp(lambda * t), s = dot(g, mu) * e;
      d_mu += g * e;
      d_lambda += s * t;
      d_axis += d * (s * lambda);
    }
    store_planes(a.d_lobes, p, i, d_axis);
    store<T>(a.d_lobes + 3 * p + i, d_lambda);
    store_planes(a.d_lobes + 4 * p, p, i, d_mu);
  }
};

}  // namespace cei3d
