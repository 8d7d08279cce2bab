// SPDX-License-Identifier: Apache-2.0
// Where the reflection lobes of a rough surface point and how wide they are. They are not round about the
// mirror direction: masking turns them towards the normal (at roughness .5 and 60 degrees by 7 degrees, their
// mean by 14), and they are narrower at grazing angles. The part of the reflection that Fresnel's term adds
// at grazing angles, the bias of the split sum, has a lobe of its own: it is narrower and stays near the
// mirror direction, and makes most of the highlights of rough dielectrics. The round lobe of
// core/math/reflection.h, turned, scaled and stretched, is fitted to the density of each
// (tools/fit_reflection.py). Its mean direction is not that of the reflected light: at grazing angles that
// has a long tail towards the normal, and its peak is what shows in pictures.
#pragma once

#include "core/math/mirror.h"
#include "core/math/reflection_pairs.h"
#include "core/math/shading.h"

namespace cei3d {

// The table of (share of the normal in the axis, roughness of a round lobe over the surface's).
const float* reflection_axis_table(ReflectionPart);

template <class T>
struct ReflectionAxis {
  Vec3<T> axis;  // unit
  T roughness;   // of the reflection_lobe() nearest to the reflection
};
// n, v: unit normal and direction to the viewer. table: reflection_axis_table() of the part, or a copy of it
// on the device that this runs on.
template <class T>
HD ReflectionAxis<T> reflection_axis(const float* table, Vec3<T> n, Vec3<T> v, T roughness) {
  const TablePair<T> p = table_pair_grad(table, dot(n, v), roughness).value;
  const T one(1.0f);
  return {normalize(mirrored_direction(n, v) * (one - p.first) + n * p.first), roughness * p.second};
}

// The table of (the stretched lobe's roughness over the surface's, its stretch).
const float* reflection_stretch_table(ReflectionPart);

// Tables of one part, or copies of them on the device that this runs on.
struct PartTables {
  const float *axis, *stretch;
};

// A stretched_lobe(): at grazing angles reflections are longer in the plane of incidence than across it.
template <class T>
struct LobeFrame {
  Vec3<T> axis;    // unit
  Vec3<T> across;  // unit, normal to the plane of incidence; shorter, down to 0, where the viewer is above
  T roughness, stretch;
  Vec3<T> normal{T(0.0f), T(0.0f), T(0.0f)};  // unit, of the surface; 0: without a horizon
};

// 1 / sin of the angle between normal and viewer, bounded at 0.
template <class T>
HD T inverse_sine(T nv) {
  return T(1.0f) / sqrt(max(T(1.0f) - nv * nv, T(0.0f)) + T(1e-3f));
}

template <class T>
HD LobeFrame<T> lobe_frame(const PartTables& tables, Vec3<T> n, Vec3<T> v, T roughness) {
  const T nv = dot(n, v);
  const ReflectionAxis<T> round = reflection_axis(tables.axis, n, v, roughness);
  const TablePair<T> p = table_pair_grad(tables.stretch, nv, roughness).value;
  return {round.axis, cross(n, v) * inverse_sine(nv), roughness * p.first, p.second, n};
}

template <class T>
struct LobeFrameGrad {
  Vec3<T> d_n, d_v;  // tangent to the unit sphere at n and v
  T d_roughness;
};
// d: dL/d(every member of the frame).
template <class T>
HD LobeFrameGrad<T> lobe_frame_grad(const PartTables& tables, Vec3<T> n, Vec3<T> v, T roughness,
                                    const LobeFrame<T>& d) {
  const T one(1.0f), nv = dot(n, v), inverse = inverse_sine(nv);
  const TablePairGrad<T> a = table_pair_grad(tables.axis, nv, roughness),
                         s = table_pair_grad(tables.stretch, nv, roughness);
  const T share = a.value.first;
  const Vec3<T> mirror = mirrored_direction(n, v), sum = mirror * (one - share) + n * share;
  const T length_of_sum = sqrt(dot(sum, sum));
  const Vec3<T> axis = sum / length_of_sum, d_sum = (d.axis - axis * dot(axis, d.axis)) / length_of_sum;
  const T d_share = dot(d_sum, n - mirror), d_ratio = d.roughness * roughness;
  const T d_inverse = dot(d.across, cross(n, v));  // by inverse_sine(), whose derivative is nv inverse^3
  const T d_nv = d_share * a.d_nv.first + d_ratio * s.d_nv.first + d.stretch * s.d_nv.second +
                 d_inverse * nv * inverse * inverse * inverse;
  const Vec3<T> by_n = d_sum * share + v * d_nv + cross(v, d.across) * inverse + d.normal,
                by_v = n * d_nv + cross(d.across, n) * inverse;
  LobeFrameGrad<T> g{by_n - n * dot(by_n, n), by_v - v * dot(by_v, v),
                     d_share * a.d_roughness.first + d.roughness * s.value.first +
                         d_ratio * s.d_roughness.first + d.stretch * s.d_roughness.second};
  mirrored_direction_grad(n, v, d_sum * (one - share), g.d_n, g.d_v);
  return g;
}

// Share of the base part in the reflection of uniform light. A metal's F0 is taken to be kMetalF0 in every
// channel, so that the share does not depend on its color.
inline constexpr float kMetalF0 = 0.8f;
template <class T>
HD T base_share(SplitSum<T> s, T specular, T metalness) {
  const T f0 = dielectric_f0(specular, metalness) + metalness * T(kMetalF0);
  return f0 * s.scale / max(reflectance(s, f0, f90_of(specular, metalness)), T(1e-6f));
}

// The mean over both lobes of something that each of them has; share: base_share().
template <class T, class V>
HD V mean_of_lobes(T share, V base, V fresnel) {
  return base * share + fresnel * (T(1.0f) - share);
}

// The reflection of a point is F0 * scale * (radiance along the base lobe) + F90 * bias * (radiance along
// Fresnel's), which is mean_of_lobes() times reflectance() if F0 is the one that base_share() takes. As a
// function of the radiance:
template <class T>
struct ReflectionGains {
  Vec3<T> base;
  T fresnel;
  // Adds the reflection of the mean radiance along the lobes to `sum`.
  HD Vec3<T> added_to(Vec3<T> sum, Vec3<T> base_radiance, Vec3<T> fresnel_radiance) const {
    return sum + base * base_radiance + fresnel_radiance * fresnel;
  }
};
template <class T>
HD ReflectionGains<T> reflection_gains(SplitSum<T> s, Vec3<T> f0, T f90) {
  return {f0 * s.scale, s.bias * f90};
}
// The reflection of a point whose F90 is 1 as a function of F0, for given radiance along the lobes.
template <class T>
struct ReflectedParts {
  Vec3<T> base;     // per unit of F0
  Vec3<T> fresnel;  // whatever F0 is
  HD Vec3<T> sum(Vec3<T> f0) const { return base * f0 + fresnel; }
  HD Vec3<T> removed_from(Vec3<T> color, Vec3<T> f0) const { return color - fresnel - base * f0; }
};
template <class T>
HD ReflectedParts<T> reflected_parts(SplitSum<T> s, Vec3<T> base_radiance, Vec3<T> fresnel_radiance) {
  return {base_radiance * s.scale, fresnel_radiance * s.bias};
}

struct ReflectionTables {
  const float* split_sum;
  PartTables base, fresnel;
};
ReflectionTables reflection_tables();  // on the host

// The two lobes of a surface point. The mean_of_lobes() of the radiance along them is the mean radiance over
// the reflection lobe, which the reflectance multiplies.
template <class T>
struct SurfaceReflection {
  LobeFrame<T> base, fresnel;
  T share;  // of the base lobe, the rest being Fresnel's
};
template <class T>
HD SurfaceReflection<T> surface_reflection(const ReflectionTables& t, Vec3<T> n, Vec3<T> v, T roughness,
                                           T specular, T metalness) {
  return {lobe_frame(t.base, n, v, roughness), lobe_frame(t.fresnel, n, v, roughness),
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
  const LobeFrameGrad<T> base = lobe_frame_grad(t.base, n, v, roughness, d.base),
                         fresnel = lobe_frame_grad(t.fresnel, n, v, roughness, d.fresnel);
  const SplitSumGrad<T> s = split_sum_grad(t.split_sum, nv, roughness);
  const T f0 = dielectric_f0(specular, metalness) + metalness * T(kMetalF0),
          f90 = f90_of(specular, metalness), sum = reflectance(s.value, f0, f90);
  const T k = select(sum < T(1e-6f), zero, d.share / (max(sum, T(1e-6f)) * max(sum, T(1e-6f))));
  // share = f0 scale / (f0 scale + f90 bias)
  const T both = k * s.value.scale * s.value.bias, d_f0 = both * f90, d_f90 = -(both * f0);
  const T d_scale = k * f0 * s.value.bias * f90, d_bias = -(k * f0 * s.value.scale * f90);
  const T d_nv = d_scale * s.d_nv.scale + d_bias * s.d_nv.bias;
  return {
      base.d_n + fresnel.d_n + (v - n * nv) * d_nv, base.d_v + fresnel.d_v + (n - v * nv) * d_nv,
      base.d_roughness + fresnel.d_roughness + d_scale * s.d_roughness.scale + d_bias * s.d_roughness.bias,
      (one - metalness) * (d_f0 * T(kDielectricF0) + d_f90 * f90_slope(specular)),
      d_f0 * (T(kMetalF0) - T(kDielectricF0) * specular) + d_f90 * (one - f90_of(specular, zero))};
}

}  // namespace cei3d
