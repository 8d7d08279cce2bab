// SPDX-License-Identifier: Apache-2.0
// The paper's specular term: a microfacet BRDF whose distribution of normals is one spherical Gaussian about
// the normal n, with sharpness and amplitude of its own [paper eq. 14],
//
//   F_s(o, i) = M amplitude exp(sharpness / (4 h.o) (i.r - 1)),   h = normalize(o + i), r = 2 (n.o) n - o.
//
// (The paper prints h.n for i.r; the factor 1 / (4 h.o) belongs to the lobe about the mirror direction r, to
// which the one about n is warped [Wang et al. 2009].) Here o is the view v, and h.o its value at i = r, n.v.
// M, Fresnel's and the shadowing term over 4 (n.i)(n.v), is taken at i = r and is constant over the lobe. The
// product with a lobe of light is a lobe, whose irradiance has a closed form, so
//
//   specular radiance = M amplitude sum_k mu_k mirrored(k),   mirrored = integral of both lobes times
//   max(n.i, 0).
#pragma once

#include "core/math/sg.h"

namespace cei3d {

inline constexpr float kMinMirrorCosine = 0.05f;  // n.v of flatter views is taken for this: 87 degrees

// Integral of a light lobe of unit peak times the lobe about r times the clamped cosine. q: squared distance
// of the light's axis from r. nl, nr: cosines of both axes to the normal. sharpness: of the lobe about r.
template <class T>
HD T sg_mirrored(T lambda, T sharpness, T q, T nl, T nr) {
  const SgProduct<T> p = sg_product(lambda, sharpness, q);
  return exp(p.log_peak) * sg_irradiance(p.lambda, (lambda * nl + sharpness * nr) / p.lambda);
}
template <class T>
struct SgMirroredGrad {
  T value, d_lambda, d_sharpness, d_q, d_nl, d_nr;
};
template <class T>
HD SgMirroredGrad<T> sg_mirrored_grad(T lambda, T sharpness, T q, T nl, T nr) {
  const SgProduct<T> p = sg_product(lambda, sharpness, q);
  const T inverse = T(1.0f) / p.lambda, c = (lambda * nl + sharpness * nr) * inverse;
  const SgCosineGrad<T> e = sg_irradiance_grad(p.lambda, c);
  const T peak = exp(p.log_peak), value = peak * e.value, d_c = peak * e.d_cosine;
  // log_peak = n - lambda - sharpness, with n, the sharpness of the product.
  const T sum = lambda + sharpness, half = T(0.5f) * q;
  const T d_n = value + peak * e.d_lambda - d_c * c * inverse;
  return {value,
          d_n * (sum - sharpness * half) * inverse - value + d_c * nl * inverse,
          d_n * (sum - lambda * half) * inverse - value + d_c * nr * inverse,
          d_n * (T(-0.5f) * lambda * sharpness * inverse),
          d_c * lambda * inverse,
          d_c * sharpness * inverse};
}

// The lobe of a view: its axis and sharpness.
template <class T>
struct MirrorLobe {
  Vec3<T> axis;
  T nv, sharpness;  // nv: cosine of normal and view, not clamped
};
template <class T>
HD MirrorLobe<T> mirror_lobe(Vec3<T> n, Vec3<T> v, T sharpness) {
  const T nv = dot(n, v);
  return {n * (T(2.0f) * nv) - v, nv, sharpness / (T(4.0f) * max(nv, T(kMinMirrorCosine)))};
}
// dL/d(n) and dL/d(sharpness) from dL/d(axis, nv, sharpness of the lobe); the view is constant.
template <class T>
struct MirrorLobeGrad {
  Vec3<T> d_normal;
  T d_sharpness;
};
template <class T>
HD MirrorLobeGrad<T> mirror_lobe_grad(Vec3<T> n, Vec3<T> v, T sharpness, MirrorLobe<T> d) {
  const T nv = dot(n, v), held = max(nv, T(kMinMirrorCosine)), inverse = T(1.0f) / (T(4.0f) * held);
  const T d_held = select(nv < T(kMinMirrorCosine), T(0.0f), -d.sharpness * sharpness * inverse / held);
  return {d.axis * (T(2.0f) * nv) + v * (T(2.0f) * dot(d.axis, n) + d.nv + d_held), d.sharpness * inverse};
}

// M: Schlick's Fresnel term as a power of two, and Smith's shadowing for both directions, over 4 (n.i)(n.v).
// [Karis 2013]
template <class T>
HD T mirror_gain(T nv, T roughness, T specular) {
  const T c = max(nv, T(kMinMirrorCosine)), k = (roughness + T(1.0f)) * (roughness + T(1.0f)) * T(0.125f);
  const T fresnel = specular + (T(1.0f) - specular) * exp((T(-3.850245f) * c - T(4.840358f)) * c);
  const T shadow = c * (T(1.0f) - k) + k;
  return fresnel / (T(4.0f) * shadow * shadow);
}
template <class T>
struct MirrorGainGrad {
  T value, d_nv, d_roughness, d_specular;
};
template <class T>
HD MirrorGainGrad<T> mirror_gain_grad(T nv, T roughness, T specular) {
  const T one(1.0f), c = max(nv, T(kMinMirrorCosine)), k = (roughness + one) * (roughness + one) * T(0.125f);
  const T rise = exp((T(-3.850245f) * c - T(4.840358f)) * c), fresnel = specular + (one - specular) * rise;
  const T shadow = c * (one - k) + k, inverse = one / shadow, gain = T(0.25f) * inverse * inverse;
  const T value = fresnel * gain, d_shadow = T(-2.0f) * value * inverse;
  const T d_c = gain * (one - specular) * rise * (T(-7.700491f) * c - T(4.840358f)) + d_shadow * (one - k);
  return {value, select(nv < T(kMinMirrorCosine), T(0.0f), d_c),
          d_shadow * (one - c) * T(0.25f) * (roughness + one), gain * (one - rise)};
}

}  // namespace cei3d
