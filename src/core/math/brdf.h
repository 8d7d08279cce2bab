// SPDX-License-Identifier: Apache-2.0
// The microfacet model: GGX distribution with alpha = roughness^2, Smith masking, Schlick's Fresnel term; its
// pre-integrated form (split sum); and its reflection lobe as a few spherical Gaussians.
// [Walter et al. 2007; Schlick 1994; Karis 2013]; and what a diffuse surface loses at flat angles [Burley
// 2012]
#pragma once

#include "core/math/vec.h"

namespace cei3d {

inline constexpr float kDielectricF0 = 0.08f;  // times Material::specular

template <class T>
HD T schlick(T f0, T cosine) {
  const T m = T(1.0f) - cosine, m2 = m * m;
  return f0 + (T(1.0f) - f0) * m2 * m2 * m;
}

// Density of microfacet normals at cosine nh to the macroscopic one; integrates to 1 against the cosine.
template <class T>
HD T ggx_density(T nh, T alpha) {
  const T a2 = alpha * alpha, d = nh * nh * (a2 - T(1.0f)) + T(1.0f);
  return a2 / (T(kPi) * d * d);
}
// Share of the facets seen from a direction at cosine c.
template <class T>
HD T smith_g1(T c, T alpha) {
  const T a2 = alpha * alpha;
  return T(2.0f) * c / (c + sqrt(a2 + (T(1.0f) - a2) * c * c));
}
// Reflectance density (1/sr) for unit vectors; zero where light or viewer is below the horizon.
template <class T>
HD T microfacet_brdf(Vec3<T> n, Vec3<T> v, Vec3<T> l, T f0, T roughness) {
  const Vec3<T> h = normalize(v + l);
  const T nv = max(dot(n, v), T(1e-6f)), nl = max(dot(n, l), T(1e-6f)), alpha = roughness * roughness;
  const T f = schlick(f0, max(dot(v, h), T(0.0f))) * ggx_density(max(dot(n, h), T(0.0f)), alpha) *
              smith_g1(nv, alpha) * smith_g1(nl, alpha) / (T(4.0f) * nv * nl);
  return select((dot(n, v) > T(0.0f)) & (dot(n, l) > T(0.0f)), f, T(0.0f));
}

// What a diffuse surface reflects from a light at cosine nl to a viewer at cosine nv, over what a Lambertian
// one does; lh: cosine between the light and the half vector. [Burley 2012, sec. 5.3]
template <class T>
HD T burley_diffuse(T nl, T nv, T lh, T roughness) {
  const T flat = T(2.0f) * roughness * lh * lh - T(0.5f), a = T(1.0f) - nl, b = T(1.0f) - nv;
  const T a2 = a * a, b2 = b * b;
  return (T(1.0f) + flat * a2 * a2 * a) * (T(1.0f) + flat * b2 * b2 * b);
}

// What a diffuse surface sends to a viewer at cosine nv, over what a Lambertian one does: a smooth one loses
// light at flat angles, a rough one throws it back [Burley 2012, sec. 5.3]. Mean over light from everywhere;
// its mean cosine to the viewer stands for all: 2/3 nv, and 1/4 nv of what comes in flat.
template <class T>
HD T diffuse_view(T nv, T roughness) {
  const T out = roughness * (T(1.0f) + nv * T(2.0f / 3)) - T(0.5f), c = T(1.0f) - nv, c2 = c * c;
  const T in = roughness * (T(1.0f) + nv * T(0.25f)) - T(0.5f);
  return (T(1.0f) + out * c2 * c2 * c) * (T(1.0f) + in * T(1.0f / 21));
}

// What a surface reflects of a uniform sky towards a viewer at cosine nv: f0 * scale + bias. By quadrature
// over importance-sampled facets (host only; tabulate it).
struct EnvBrdf {
  float scale, bias;
};
inline EnvBrdf env_brdf(double roughness, double nv) {
  const double alpha = roughness * roughness;
  const Vec3d v{std::sqrt(1 - nv * nv), 0, nv};
  const int rings = 128, steps = 32;
  double scale = 0, bias = 0;
  for (int i = 0; i < rings; ++i) {
    const double u = (i + 0.5) / rings, c = std::sqrt((1 - u) / (1 + (alpha * alpha - 1) * u)),
                 s = std::sqrt(1 - c * c);
    for (int j = 0; j < steps; ++j) {
      const double a = M_PI * (j + 0.5) / steps;  // half a turn: the other half mirrors it
      const Vec3d h{s * std::cos(a), s * std::sin(a), c};
      const double vh = dot(v, h), nl = 2 * vh * h.z - v.z;
      if (vh <= 0 || nl <= 0) continue;
      const double g = smith_g1(nv, alpha) * smith_g1(nl, alpha) * vh / (c * nv), f = schlick(0.0, vh);
      scale += g * (1 - f);
      bias += g * f;
    }
  }
  return {float(scale / (rings * steps)), float(bias / (rings * steps))};
}

// The reflection lobe of GGX seen along the normal, in incident directions at angle t to the mirror
// direction: proportional to 1 / (1 + x)^2 with x = (t / (2 alpha))^2 for small angles, and masked towards
// the horizon. Since 1 / (1 + x)^2 is the integral of s e^-s e^(-s x) ds, the lobe is a mixture of Gaussians
// with sharpness s / alpha^2; five of them, fitted to the logarithm of the density and to the energy within
// each angle over roughness 0.1 to 0.65, follow it to 99.5 % of its energy (energy within an angle: .01 root
// mean square up to roughness 0.45, .07 at 0.8). The broad ones matter: they bring the sun to where the
// mirror direction is dark.
inline constexpr int kReflectionLobes = 5;
inline constexpr float kReflectionNodes[5] = {0.0073650f, 0.0354975f, 0.1154150f, 0.3714659f, 1.3242071f};
inline constexpr float kReflectionShare[5] = {0.0267184f, 0.0805499f, 0.1724400f, 0.5452267f,
                                              0.1750652f};  // of the energy
// Smoother surfaces are shaded like this one: sharper lobes are beyond single precision, and show no
// difference.
inline constexpr float kLeastRoughness = 0.05f;
// Sharpness of lobe j is kReflectionNodes[j] * reflection_scale(roughness).
inline float reflection_scale(float roughness) {
  const float alpha = roughness * roughness;
  return (1 + alpha * (-0.3258968f + 5.6732834f * alpha)) / (alpha * alpha);
}

}  // namespace cei3d
