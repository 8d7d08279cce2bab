// SPDX-License-Identifier: Apache-2.0
// What a batch of surface points receives from the light's lobes, in closed form. Item: a point.
#pragma once

#include "core/compute/kernels/light.h"
#include "core/math/brdf.h"
#include "core/math/sg.h"

namespace cei3d {

// Irradiance of points with free sky.
struct SgIrradiance {
  struct Args {
    LobePlanes lobes;
    int stride;            // n padded to 32
    const float* normals;  // [3][stride] unit
    float* out;            // [3][stride]
  };
  template <class T>
  static HD void run(const Args& a, int i) {
    const Vec3<T> n = load_planes<T>(a.normals, a.stride, i);
    Vec3<T> sum{T(0.0f), T(0.0f), T(0.0f)};
    for (int k = 0; k < a.lobes.count; ++k)
      sum += a.lobes.mu<T>(k) * sg_irradiance(a.lobes.lambda<T>(k), dot(n, a.lobes.axis<T>(k)));
    for (int c = 0; c < 3; ++c) sum[c] = max(sum[c], T(0.0f));
    store_planes(a.out, a.stride, i, sum);
  }
};

// Radiance of the free sky blurred by the reflection lobe around the mirror direction.
struct SgReflection {
  struct Args {
    LobePlanes lobes;
    float sharpness[kReflectionLobes], weight[kReflectionLobes];  // of the reflection lobe; see reflection_args
    int stride;
    const float* mirrors;   // [3][stride] unit
    float* out;             // [3][stride]
  };
  template <class T>
  static HD void run(const Args& a, int i) {
    const Vec3<T> r = load_planes<T>(a.mirrors, a.stride, i);
    Vec3<T> sum{T(0.0f), T(0.0f), T(0.0f)};
    for (int k = 0; k < a.lobes.count; ++k) {
      const T lambda = a.lobes.lambda<T>(k);
      const Vec3<T> d = r - a.lobes.axis<T>(k);
      const T q = dot(d, d);
      T share(0.0f);
      for (int j = 0; j < kReflectionLobes; ++j) share += T(a.weight[j]) * sg_inner(lambda, T(a.sharpness[j]), q);
      sum += a.lobes.mu<T>(k) * share;
    }
    store_planes(a.out, a.stride, i, sum);
  }
};

inline void set_reflection_lobe(float roughness, SgReflection::Args& a) {
  const float alpha = roughness * roughness;
  for (int j = 0; j < kReflectionLobes; ++j) {
    a.sharpness[j] = kReflectionSharpness[j] / (alpha * alpha);
    a.weight[j] = kReflectionShare[j] / sg_integral(a.sharpness[j]);
  }
}

}  // namespace cei3d
