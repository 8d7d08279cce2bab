// SPDX-License-Identifier: Apache-2.0
// The shading model: the radiance that a surface point sends to the viewer, and its adjoint. The
// metallic-roughness model of glTF: the diffuse term is (1 - metalness) albedo / pi, F0 is metalness * albedo
// + (1 - metalness) * kDielectricF0 * specular; the specular term is the split sum. In the whole program
// these formulas are written out here and, for a reflection that is the sum of two lobes, in
// reflection_axis.h; `lit` in src/web/shaders.js repeats for WebGL what tables cannot hold, and
// tests/e2e/page.sh compares its pictures with the program's. [paper eq. 2-5, 13-15]
#pragma once

#include "core/math/mirror.h"
#include "core/math/split_sum.h"

namespace cei3d {

// Light that arrives at a point: from the environment as far as the object does not occlude it, and from the
// object.
template <class T>
struct IncidentLight {
  Vec3<T> sky_irradiance;     // of the environment without occlusion
  Vec3<T> visibility;         // fraction of it that arrives, per channel
  Vec3<T> bounce;             // irradiance from the object
  Vec3<T> sky_reflection;     // mean radiance of the environment over the reflection lobe, without occlusion
  Vec3<T> mirror_visibility;  // fraction of that radiance that is not occluded, per channel
  Vec3<T> object_reflection;  // mean radiance from the object over the lobe, 0 where it is not occluded
  DiffuseLight<T> diffuse_light{};  // of the environment

  HD Vec3<T> irradiance() const { return sky_irradiance * visibility + bounce; }
  HD Vec3<T> reflected() const { return sky_reflection * mirror_visibility + object_reflection; }
};
// dL/d(each member) but the last from dL/d(irradiance) and dL/d(reflected radiance).
template <class T>
HD IncidentLight<T> incident_light_grad(const IncidentLight<T>& light, Vec3<T> d_irradiance,
                                        Vec3<T> d_reflected) {
  return {d_irradiance * light.visibility,       d_irradiance * light.sky_irradiance, d_irradiance,
          d_reflected * light.mirror_visibility, d_reflected * light.sky_reflection,  d_reflected};
}

// Everything that the radiance of a point depends on; in an adjoint, the derivatives by it.
template <class T>
struct ShadingPoint {
  Vec3<T> albedo;                    // [0, 1], linear; glTF's base color
  T roughness, specular, metalness;  // [0, 1]
  T nv;                              // cosine of normal and direction to the viewer
  Vec3<T> irradiance;                // all of it
  Vec3<T> reflected;                 // mean radiance over the reflection lobe
  DiffuseLight<T> diffuse_light;
};

template <class T>
HD T dielectric_f0(T specular, T metalness) {
  return (T(1.0f) - metalness) * T(kDielectricF0) * specular;
}
// Reflectance at normal incidence.
template <class T>
HD Vec3<T> f0_of(Vec3<T> albedo, T specular, T metalness) {
  const T dielectric = dielectric_f0(specular, metalness);
  return albedo * metalness + Vec3<T>{dielectric, dielectric, dielectric};
}
// Reflectance at grazing angles (F90). A dielectric that reflects less than usual along the normal does so at
// all angles, as one with pores does: below kUsualSpecular the strength is that of the whole reflection, like
// glTF's specularFactor.
template <class T>
HD T f90_of(T specular, T metalness) {
  const T one(1.0f);
  return metalness + (one - metalness) * min(specular * T(1 / kUsualSpecular), one);
}
// Its derivative by `specular`, of a dielectric.
template <class T>
HD T f90_slope(T specular) {
  return select(specular < T(kUsualSpecular), T(1 / kUsualSpecular), T(0.0f));
}
// Fraction of the irradiance that a white surface sends to the viewer, but for diffuse_view().
template <class T>
HD T diffuse_share(T metalness) {
  return (T(1.0f) - metalness) * T(1 / kPi);
}
// Fraction of the reflected radiance that reaches the viewer, of one channel or of three.
template <class T>
HD T reflectance(SplitSum<T> s, T f0, T f90) {
  return f0 * s.scale + f90 * s.bias;
}
template <class T>
HD Vec3<T> reflectance(SplitSum<T> s, Vec3<T> f0, T f90) {
  return f0 * s.scale + Vec3<T>{s.bias, s.bias, s.bias} * f90;
}

// The radiance as a linear function of the albedo: diffuse = diffuse_gain * albedo, specular = specular_gain
// * albedo + specular_offset.
template <class T>
struct ShadingTerms {
  Vec3<T> diffuse_gain, specular_gain, specular_offset;

  HD Vec3<T> diffuse(Vec3<T> albedo) const { return albedo * diffuse_gain; }
  HD Vec3<T> specular(Vec3<T> albedo) const { return albedo * specular_gain + specular_offset; }
  HD Vec3<T> gain() const { return diffuse_gain + specular_gain; }
  HD Vec3<T> radiance(Vec3<T> albedo) const { return specular_offset + albedo * gain(); }
};

// table: split_sum_table(). Does not read p.albedo.
template <class T>
HD ShadingTerms<T> shading_terms(const float* table, const ShadingPoint<T>& p) {
  const T zero(0.0f), one(1.0f);
  const SplitSum<T> s = split_sum(table, p.nv, p.roughness);
  const T view = diffuse_view(clamp(p.nv, zero, one), max(p.roughness, T(kMinRoughness)), p.diffuse_light);
  const Vec3<T> white{one, one, one}, black{zero, zero, zero};
  const Vec3<T> offset =
      reflectance(s, f0_of(black, p.specular, p.metalness), f90_of(p.specular, p.metalness));
  return {p.irradiance * (diffuse_share(p.metalness) * view), p.reflected * ((white * p.metalness) * s.scale),
          p.reflected * offset};
}

// dL/d(every member of the point) from dL/d(diffuse) and dL/d(specular).
template <class T>
HD ShadingPoint<T> shading_grad(const float* table, const ShadingPoint<T>& p, Vec3<T> d_diffuse,
                                Vec3<T> d_specular) {
  const T zero(0.0f), one(1.0f), k = diffuse_share(p.metalness);
  const SplitSumGrad<T> s = split_sum_grad(table, p.nv, p.roughness);
  const DiffuseViewGrad<T> view =
      diffuse_view_grad(clamp(p.nv, zero, one), max(p.roughness, T(kMinRoughness)), p.diffuse_light);
  const Vec3<T> f0 = f0_of(p.albedo, p.specular, p.metalness);
  const T f90 = f90_of(p.specular, p.metalness), dielectric_f90 = f90_of(p.specular, zero);
  const T lit = dot(d_diffuse, p.albedo * p.irradiance), mirrored = dot(d_specular, p.reflected),
          mirrored_f0 = dot(d_specular, p.reflected * f0),
          mirrored_albedo = dot(d_specular, p.reflected * p.albedo);
  const auto nv_clamped = (p.nv < zero) | (p.nv > one);
  const auto roughness_clamped = p.roughness < T(kMinRoughness);
  ShadingPoint<T> d;
  d.albedo =
      d_diffuse * p.irradiance * (k * view.value) + d_specular * p.reflected * (p.metalness * s.value.scale);
  d.roughness = lit * k * select(roughness_clamped, zero, view.d_roughness) +
                mirrored_f0 * s.d_roughness.scale + mirrored * s.d_roughness.bias * f90;
  d.specular = mirrored * (one - p.metalness) *
               (s.value.scale * T(kDielectricF0) + s.value.bias * f90_slope(p.specular));
  d.metalness = (mirrored_albedo - mirrored * T(kDielectricF0) * p.specular) * s.value.scale +
                mirrored * s.value.bias * (one - dielectric_f90) - lit * T(1 / kPi) * view.value;
  d.nv = lit * k * select(nv_clamped, zero, view.d_nv) + mirrored_f0 * s.d_nv.scale +
         mirrored * s.d_nv.bias * f90;
  d.irradiance = d_diffuse * p.albedo * (k * view.value);
  d.reflected = d_specular * reflectance(s.value, f0, f90);
  d.diffuse_light = {lit * k * view.d_light.lv, lit * k * view.d_light.grazing,
                     lit * k * view.d_light.grazing_lv};
  return d;
}

}  // namespace cei3d
