// SPDX-License-Identifier: Apache-2.0
// Where the reflection lobes of a rough surface point and how wide they are. They are not round about the
// mirror direction: masking and the horizon turn them towards the normal (at roughness .5 and 60 degrees by
// 14 degrees), and they are narrower at grazing angles. The part of the reflection that Fresnel's term adds
// at grazing angles, the bias of the split sum, has a lobe of its own: it is narrower and stays near the
// mirror direction, and makes most of the highlights of rough dielectrics. The round lobe of
// core/math/reflection.h, turned and scaled, gets the mean direction of each: its axis, and the length of the
// mean as a measure of its width.
#pragma once

#include "core/math/mirror.h"
#include "core/math/shading.h"

namespace cei3d {

// The parts of the split sum: base is scaled by F0, fresnel is what Schlick's term adds to it at grazing
// angles.
enum class ReflectionPart { base, fresnel };

// The table of (share of the normal in the axis, lobe's roughness over the surface's). Made on first use
// (20 ms).
const float* reflection_axis_table(ReflectionPart);

template <class T>
struct ReflectionAxis {
  Vec3<T> axis;  // unit
  T roughness;   // for which reflection_lobe() is as wide
};
// n, v: unit normal and direction to the viewer. table: reflection_axis_table() of the part, or a copy of it
// on the device that this runs on.
template <class T>
HD ReflectionAxis<T> reflection_axis(const float* table, Vec3<T> n, Vec3<T> v, T roughness) {
  const TablePair<T> p = table_pair_grad(table, dot(n, v), roughness).value;
  const T one(1.0f);
  return {normalize(mirrored_direction(n, v) * (one - p.first) + n * p.first), roughness * p.second};
}

template <class T>
struct ReflectionAxisGrad {
  Vec3<T> d_n, d_v;  // tangent to the unit sphere at n and v
  T d_roughness;
};
// From dL/d(axis) and dL/d(the lobe's roughness).
template <class T>
HD ReflectionAxisGrad<T> reflection_axis_grad(const float* table, Vec3<T> n, Vec3<T> v, T roughness,
                                              Vec3<T> d_axis, T d_lobe_roughness) {
  const T one(1.0f), nv = dot(n, v);
  const TablePairGrad<T> p = table_pair_grad(table, nv, roughness);
  const T share = p.value.first;
  const Vec3<T> mirror = mirrored_direction(n, v), sum = mirror * (one - share) + n * share;
  const T length_of_sum = sqrt(dot(sum, sum));
  const Vec3<T> axis = sum / length_of_sum, d_sum = (d_axis - axis * dot(axis, d_axis)) / length_of_sum;
  const T d_share = dot(d_sum, n - mirror);
  const T d_nv = d_share * p.d_nv.first + d_lobe_roughness * roughness * p.d_nv.second;
  const Vec3<T> by_n = d_sum * share + v * d_nv, by_v = n * d_nv;
  ReflectionAxisGrad<T> g{
      by_n - n * dot(by_n, n), by_v - v * dot(by_v, v),
      d_share * p.d_roughness.first + d_lobe_roughness * (p.value.second + roughness * p.d_roughness.second)};
  mirrored_direction_grad(n, v, d_sum * (one - share), g.d_n, g.d_v);
  return g;
}

// Share of the base part in the reflection of uniform light. A metal's F0 is taken to be kMetalF0 in every
// channel, so that the share does not depend on its color.
inline constexpr float kMetalF0 = 0.8f;
template <class T>
HD T base_share(SplitSum<T> s, T specular, T metalness) {
  const T base = (dielectric_f0(specular, metalness) + metalness * T(kMetalF0)) * s.scale;
  return base / max(base + s.bias, T(1e-6f));
}

struct ReflectionTables {
  const float *split_sum, *base, *fresnel;
};
ReflectionTables reflection_tables();  // on the host

// The two lobes of a surface point. Their weighted sum of incident radiance is the mean radiance over the
// reflection lobe, which the reflectance multiplies.
template <class T>
struct SurfaceReflection {
  ReflectionAxis<T> base, fresnel;
  T share;  // of the base lobe, the rest being Fresnel's
};
template <class T>
HD SurfaceReflection<T> surface_reflection(const ReflectionTables& t, Vec3<T> n, Vec3<T> v, T roughness,
                                           T specular, T metalness) {
  return {reflection_axis(t.base, n, v, roughness), reflection_axis(t.fresnel, n, v, roughness),
          base_share(split_sum(t.split_sum, dot(n, v), roughness), specular, metalness)};
}

template <class T>
struct SurfaceReflectionGrad {
  Vec3<T> d_n, d_v;  // tangent to the unit sphere at n and v
  T d_roughness, d_specular, d_metalness;
};
// d: dL/d(every member of the reflection).
template <class T>
HD SurfaceReflectionGrad<T> surface_reflection_grad(const ReflectionTables& t, Vec3<T> n, Vec3<T> v,
                                                    T roughness, T specular, T metalness,
                                                    const SurfaceReflection<T>& d) {
  const T one(1.0f), zero(0.0f), nv = dot(n, v);
  const ReflectionAxisGrad<T> base =
      reflection_axis_grad(t.base, n, v, roughness, d.base.axis, d.base.roughness);
  const ReflectionAxisGrad<T> fresnel =
      reflection_axis_grad(t.fresnel, n, v, roughness, d.fresnel.axis, d.fresnel.roughness);
  const SplitSumGrad<T> s = split_sum_grad(t.split_sum, nv, roughness);
  const T f0 = dielectric_f0(specular, metalness) + metalness * T(kMetalF0),
          sum = f0 * s.value.scale + s.value.bias;
  const T k = select(sum < T(1e-6f), zero, d.share / (max(sum, T(1e-6f)) * max(sum, T(1e-6f))));
  const T d_f0 = k * s.value.scale * s.value.bias;  // share = f0 scale / (f0 scale + bias)
  const T d_scale = k * f0 * s.value.bias, d_bias = -(k * f0 * s.value.scale);
  const T d_nv = d_scale * s.d_nv.scale + d_bias * s.d_nv.bias;
  return {
      base.d_n + fresnel.d_n + (v - n * nv) * d_nv, base.d_v + fresnel.d_v + (n - v * nv) * d_nv,
      base.d_roughness + fresnel.d_roughness + d_scale * s.d_roughness.scale + d_bias * s.d_roughness.bias,
      d_f0 * (one - metalness) * T(kDielectricF0), d_f0 * (T(kMetalF0) - T(kDielectricF0) * specular)};
}

}  // namespace cei3d
