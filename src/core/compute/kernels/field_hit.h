// SPDX-License-Identifier: Apache-2.0
// Hits of rays on the zero set of a field, and the adjoint: core/math/field_hit.h for a batch of traced hits.
// Arrays are planes [rows][stride].
#pragma once

#include "core/compute/kernel.h"
#include "core/compute/kernels/lobes.h"
#include "core/math/field_hit.h"

namespace cei3d {

// Traced hits and the field there; see TracedHit.
struct TracedHitPlanes {
  int stride;
  const float* depths;           // [stride]
  const float* positions;        // [3][stride]
  const float* directions;       // [3][stride]
  const float* values;           // [stride]
  const float* gradients;        // [3][stride]
  const float* gradients_along;  // [3][stride]
  template <class T>
  HD TracedHit<T> at(int i) const {
    return {load<T>(depths + i),
            load_planes<T>(positions, stride, i),
            load_planes<T>(directions, stride, i),
            load<T>(values + i),
            load_planes<T>(gradients, stride, i),
            load_planes<T>(gradients_along, stride, i)};
  }
};

// Item: a hit.
struct FieldHits {
  struct Args {
    TracedHitPlanes hits;
    float* depths;               // [stride]
    float *positions, *normals;  // [3][stride]
  };
  template <class T>
  static HD void run(const Args& a, int i) {
    const FieldHit<T> h = field_hit(a.hits.at<T>(i));
    store<T>(a.depths + i, h.depth);
    store_planes(a.positions, a.hits.stride, i, h.position);
    store_planes(a.normals, a.hits.stride, i, h.normal);
  }
};

// Item: a hit.
struct FieldHitsGrad {
  struct Args {
    TracedHitPlanes hits;
    const float* d_depths;                 // [stride]
    const float *d_positions, *d_normals;  // [3][stride]
    float* d_values;                       // [stride]
    float* d_gradients;                    // [3][stride]
  };
  template <class T>
  static HD void run(const Args& a, int i) {
    const int stride = a.hits.stride;
    const TracedHitGrad<T> d = field_hit_grad(
        a.hits.at<T>(i), FieldHit<T>{load<T>(a.d_depths + i), load_planes<T>(a.d_positions, stride, i),
                                     load_planes<T>(a.d_normals, stride, i)});
    store<T>(a.d_values + i, d.d_value);
    store_planes(a.d_gradients, stride, i, d.d_gradient);
  }
};

}  // namespace cei3d
