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
    float sharpness[kReflectionLobes],
        weight[kReflectionLobes];  // of the reflection lobe; see reflection_args
    int stride;
    const float* mirrors;  // [3][stride] unit
    float* out;            // [3][stride]
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
      for (int j = 0; j < kReflectionLobes; ++j)
        share += T(a.weight[j]) * sg_inner(lambda, T(a.sharpness[j]), q);
      sum += a.lobes.mu<T>(k) * share;
    }
    store_planes(a.out, a.stride, i, sum);
  }
};

// Adjoint of SgReflection, for the mirror directions: as if their length were free.
struct SgReflectionSlope {
  struct Args {
    LobePlanes lobes;
    float sharpness[kReflectionLobes], weight[kReflectionLobes];
    int stride;
    const float *mirrors, *d_reflected;  // [3][stride]
    float* d_mirrors;                    // [3][stride], written
  };
  template <class T>
  static HD void run(const Args& a, int i) {
    const Vec3<T> r = load_planes<T>(a.mirrors, a.stride, i), g = load_planes<T>(a.d_reflected, a.stride, i);
    Vec3<T> sum{T(0.0f), T(0.0f), T(0.0f)};
    for (int k = 0; k < a.lobes.count; ++k) {
      const T lambda = a.lobes.lambda<T>(k);
      const Vec3<T> d = r - a.lobes.axis<T>(k);
      const T q = dot(d, d);
      T slope(0.0f);
      for (int j = 0; j < kReflectionLobes; ++j)
        slope += T(a.weight[j]) * sg_inner_slopes(lambda, T(a.sharpness[j]), q).d_q;
      sum += d * (T(2.0f) * slope * dot(g, a.lobes.mu<T>(k)));
    }
    store_planes(a.d_mirrors, a.stride, i, sum);
  }
};

// Adjoint of both, for the lobes. Item: a lobe; adds up what the points [begin, end) say about it.
struct SgShadeGrad {
  struct Args {
    LobePlanes lobes;
    float sharpness[kReflectionLobes], weight[kReflectionLobes];
    int stride, begin, end;
    const float *normals, *mirrors;           // [3][stride]
    const float *d_irradiance, *d_reflected;  // [3][stride]
    float* d_lobes;                           // [7][padded]: axis, sharpness, colour; written
  };
  template <class T>
  static HD void run(const Args& a, int i) {
    const int p = a.lobes.padded;
    const Vec3<T> axis = load_planes<T>(a.lobes.data, p, i), mu = load_planes<T>(a.lobes.data + 4 * p, p, i);
    const T lambda = max(load<T>(a.lobes.data + 3 * p + i), T(0.1f)), zero(0.0f);  // padding has none
    Vec3<T> d_axis{zero, zero, zero}, d_mu{zero, zero, zero};
    T d_lambda = zero;
    for (int h = a.begin; h < a.end; ++h) {
      const Vec3<T> n = point<T>(a.normals, a.stride, h), e = point<T>(a.d_irradiance, a.stride, h);
      const SgSlopes<T> diffuse = sg_irradiance_slopes(lambda, dot(n, axis));
      const T ye = dot(e, mu);
      d_mu += e * diffuse.value;
      d_lambda += ye * diffuse.d_lambda;
      d_axis += n * (ye * diffuse.d_cosine);
      const Vec3<T> r = point<T>(a.mirrors, a.stride, h), g = point<T>(a.d_reflected, a.stride, h),
                    gap = r - axis;
      const T q = dot(gap, gap), yg = dot(g, mu);
      T share = zero, slope = zero, along = zero;
      for (int j = 0; j < kReflectionLobes; ++j) {
        const SgInnerSlopes<T> s = sg_inner_slopes(lambda, T(a.sharpness[j]), q);
        share += T(a.weight[j]) * s.value;
        slope += T(a.weight[j]) * s.d_lambda1;
        along += T(a.weight[j]) * s.d_q;
      }
      d_mu += g * share;
      d_lambda += yg * slope;
      d_axis += gap * (T(-2.0f) * yg * along);
    }
    store_planes(a.d_lobes, p, i, d_axis);
    store<T>(a.d_lobes + 3 * p + i, d_lambda);
    store_planes(a.d_lobes + 4 * p, p, i, d_mu);
  }

 private:
  template <class T>
  static HD Vec3<T> point(const float* p, int stride, int i) {
    return {T(p[i]), T(p[stride + i]), T(p[2 * stride + i])};
  }
};

template <class Args>
void set_reflection_lobe(float roughness, Args& a) {
  const float scale = reflection_scale(roughness);
  float above = 0;  // the horizon, seen along the normal: that much is what the reflectance counts as all
  for (int j = 0; j < kReflectionLobes; ++j) {
    a.sharpness[j] = kReflectionNodes[j] * scale;
    a.weight[j] = kReflectionShare[j] / sg_integral(a.sharpness[j]);
    above += kReflectionShare[j] / (1 + exp(-a.sharpness[j]));
  }
  for (float& w : a.weight) w /= above;
}

}  // namespace cei3d
