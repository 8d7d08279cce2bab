// SPDX-License-Identifier: Apache-2.0
// The microfacet model: GGX normal distribution with alpha = roughness^2, Smith masking, Fresnel's term
// [Walter et al. 2007]; Burley's diffuse term [Burley 2012]. Roughness is in
// [kMinRoughness, 1]; cosines are those of angles to the normal.
#pragma once

#include "core/math/vec.h"

namespace cei3d {

// F0 of a dielectric is kDielectricF0 * specular [Burley 2012, sec. 5.5]; a usual one has a refractive index
// of 1.5, hence 0.04.
inline constexpr float kDielectricF0 = 0.08f, kUsualSpecular = 0.5f;

// Smoother surfaces are shaded with this roughness: sharper lobes exceed single precision, and the difference
// is not visible in images.
inline constexpr float kMinRoughness = 0.05f;

// Reflectance of a smooth surface that has f0 along the normal, seen at a cosine in [0, 1]: it rises to 1 as
// that of a dielectric of index 1.5 does. [Walter et al. 2007, eq. 22] Schlick's power is up to 23 % less
// for such a dielectric, at 56 degrees, and makes light that is known by its reflections too bright.
template <class T>
HD T fresnel(T f0, T cosine) {
  const T one(1.0f), g = sqrt(cosine * cosine + T(1.25f));  // the index squared minus 1
  const T s = (g - cosine) / (g + cosine), sum = cosine * (g + cosine) - one,
          difference = cosine * (g - cosine) + one, p = sum / difference;
  const T reflectance = T(0.5f) * s * s * (one + p * p);  // 1/25 along the normal
  return f0 + (one - f0) * (reflectance * T(25.0f) - one) * T(1.0f / 24);
}

// Density of microfacet normals (1/sr) at cosine nh to the surface normal; its integral against the cosine
// is 1.
template <class T>
HD T ggx_density(T nh, T alpha) {
  const T a2 = alpha * alpha, d = nh * nh * (a2 - T(1.0f)) + T(1.0f);
  return a2 / (T(kPi) * d * d);
}
// Smith's masking: fraction of the microfacets that are visible from a direction at cosine c.
template <class T>
HD T smith_g1(T c, T alpha) {
  const T a2 = alpha * alpha;
  return T(2.0f) * c / (c + sqrt(a2 + (T(1.0f) - a2) * c * c));
}
// The specular BRDF (1/sr) for unit vectors n (normal), v (to the viewer), l (to the light) [paper eq. 5];
// zero where the viewer or the light is below the horizon.
template <class T>
HD T microfacet_brdf(Vec3<T> n, Vec3<T> v, Vec3<T> l, T f0, T roughness) {
  const Vec3<T> h = normalize(v + l);
  const T nv = max(dot(n, v), T(1e-6f)), nl = max(dot(n, l), T(1e-6f)), alpha = roughness * roughness;
  const T f = fresnel(f0, max(dot(v, h), T(0.0f))) * ggx_density(max(dot(n, h), T(0.0f)), alpha) *
              smith_g1(nv, alpha) * smith_g1(nl, alpha) / (T(4.0f) * nv * nl);
  return select((dot(n, v) > T(0.0f)) & (dot(n, l) > T(0.0f)), f, T(0.0f));
}

// (1 - cosine)^5, which is large only at grazing angles.
template <class T>
HD T grazing(T cosine) {
  const T c = T(1.0f) - cosine, c2 = c * c;
  return c2 * c2 * c;
}

// Burley's diffuse term relative to a Lambertian one, for a light at cosine nl and a viewer at cosine nv; lh
// is the cosine of light and half vector. [Burley 2012, sec. 5.3]
template <class T>
HD T burley_diffuse(T nl, T nv, T lh, T roughness) {
  const T flat = T(2.0f) * roughness * lh * lh - T(0.5f);
  return (T(1.0f) + flat * grazing(nl)) * (T(1.0f) + flat * grazing(nv));
}

// What Burley's diffuse term depends on in the light that reaches a point: means over that light, weighted by
// the cosine to the normal.
template <class T>
struct DiffuseLight {
  T lv;          // cosine of light and viewer
  T grazing;     // grazing(nl)
  T grazing_lv;  // their product
};
// Of light that comes evenly from everywhere.
template <class T>
HD DiffuseLight<T> even_light(T nv) {
  return {nv * T(2.0f / 3), T(1.0f / 21), nv * T(1.0f / 84)};
}
// dL/d(nv) from dL/d(its members).
template <class T>
HD T even_light_grad(const DiffuseLight<T>& d) {
  return d.lv * T(2.0f / 3) + d.grazing_lv * T(1.0f / 84);
}

// Reflected radiance of a diffuse surface towards a viewer at cosine nv, relative to a Lambertian one: a
// smooth surface is darker where light enters or leaves at a grazing angle, a rough one brighter. The mean of
// Burley's diffuse term, but for the product of the deviations of its two factors.
template <class T>
HD T diffuse_view(T nv, T roughness, const DiffuseLight<T>& light) {
  const T half(0.5f), view = roughness * (T(1.0f) + light.lv) - half;
  return (T(1.0f) + view * grazing(nv)) *
         (T(1.0f) + (roughness - half) * light.grazing + roughness * light.grazing_lv);
}
// Under even light.
template <class T>
HD T diffuse_view(T nv, T roughness) {
  return diffuse_view(nv, roughness, even_light(nv));
}

template <class T>
struct DiffuseViewGrad {
  T value, d_nv, d_roughness;
  DiffuseLight<T> d_light;
};
template <class T>
HD DiffuseViewGrad<T> diffuse_view_grad(T nv, T roughness, const DiffuseLight<T>& light) {
  const T one(1.0f), half(0.5f), c5 = grazing(nv), c2 = square(one - nv), c4 = c2 * c2;
  const T view = roughness * (one + light.lv) - half, view_factor = one + view * c5;
  const T light_factor = one + (roughness - half) * light.grazing + roughness * light.grazing_lv;
  return {view_factor * light_factor,
          T(-5.0f) * view * c4 * light_factor,
          (one + light.lv) * c5 * light_factor + view_factor * (light.grazing + light.grazing_lv),
          {roughness * c5 * light_factor, view_factor * (roughness - half), view_factor * roughness}};
}

}  // namespace cei3d
