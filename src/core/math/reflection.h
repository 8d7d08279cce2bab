// SPDX-License-Identifier: Apache-2.0
// The reflection of light lobes by a rough surface, in closed form: the GGX lobe as a mixture of spherical
// Gaussians, and its product with the light's. [paper eq. 14 with five Gaussians in place of one]
#pragma once

#include "core/math/brdf.h"
#include "core/math/sg.h"

namespace cei3d {

// The GGX lobe around the mirror direction, for a viewer above the surface, as a mixture of spherical
// Gaussians. For small angles t between light and mirror direction it is proportional to 1 / (1 + x)^2 with x
// = (t / (2 alpha))^2, and 1 / (1 + x)^2 is the integral of s e^-s e^(-s x) ds: a mixture of Gaussians of
// sharpness s / alpha^2. Five of them, fitted to the logarithm of the density and to the energy within each
// angle over roughness 0.1 to 0.65, hold 99.5 % of the energy (root mean square error of the energy within an
// angle: .01 up to roughness 0.45, .07 at 0.8). The broad ones carry the sun to points whose mirror direction
// is dark.
inline constexpr int kReflectionLobes = 5;
HD constexpr float reflection_node(int j) {
  constexpr float kNodes[kReflectionLobes] = {0.0073650f, 0.0354975f, 0.1154150f, 0.3714659f, 1.3242071f};
  return kNodes[j];
}
// Fraction of the energy in each.
HD constexpr float reflection_share(int j) {
  constexpr float kShares[kReflectionLobes] = {0.0267184f, 0.0805499f, 0.1724400f, 0.5452267f, 0.1750652f};
  return kShares[j];
}

// Sharpness of Gaussian j is reflection_node(j) * reflection_scale(roughness).
template <class T>
HD T reflection_scale(T roughness) {
  const T alpha = roughness * roughness;
  return (T(1.0f) + alpha * (T(-0.3258968f) + T(5.6732834f) * alpha)) / (alpha * alpha);
}
template <class T>
HD T reflection_scale_grad(T roughness) {  // d / d roughness
  const T alpha = roughness * roughness, inverse = T(1.0f) / alpha;
  return T(2.0f) * roughness * inverse * inverse * (T(0.3258968f) - T(2.0f) * inverse);
}

// The mixture for one roughness: sharpness lambda[j], and weight[j] of unit-height Gaussians, so that the
// integral over the sphere is 1.
template <class T>
struct ReflectionLobe {
  T lambda[kReflectionLobes], weight[kReflectionLobes];
};
template <class T>
HD ReflectionLobe<T> reflection_lobe(T roughness) {
  const T scale = reflection_scale(max(roughness, T(kMinRoughness)));
  ReflectionLobe<T> lobe;
  for (int j = 0; j < kReflectionLobes; ++j) {
    lobe.lambda[j] = T(reflection_node(j)) * scale;
    lobe.weight[j] = T(reflection_share(j)) / sg_integral(lobe.lambda[j]);
  }
  return lobe;
}

// The mixture and its derivatives by the roughness; below kMinRoughness they are 0.
template <class T>
struct ReflectionLobeGrad {
  ReflectionLobe<T> lobe;
  T d_lambda[kReflectionLobes], d_weight[kReflectionLobes];
};
template <class T>
HD ReflectionLobeGrad<T> reflection_lobe_grad(T roughness) {
  const T clamped = max(roughness, T(kMinRoughness));
  const T d_scale = select(roughness < T(kMinRoughness), T(0.0f), reflection_scale_grad(clamped));
  ReflectionLobeGrad<T> g{reflection_lobe(roughness), {}, {}};
  for (int j = 0; j < kReflectionLobes; ++j) {
    g.d_lambda[j] = T(reflection_node(j)) * d_scale;
    const T d_integral = sg_integral_grad(g.lobe.lambda[j]) * g.d_lambda[j];
    g.d_weight[j] = -(g.lobe.weight[j] * d_integral / sg_integral(g.lobe.lambda[j]));
  }
  return g;
}

// Radiance of a light lobe of unit height and sharpness lambda, averaged over the reflection lobe; q is the
// squared distance of the light's axis and the mirror direction on the unit sphere.
template <class T>
HD T sg_reflected(T lambda, const ReflectionLobe<T>& lobe, T q) {
  T sum(0.0f);
  for (int j = 0; j < kReflectionLobes; ++j) sum += lobe.weight[j] * sg_inner(lambda, lobe.lambda[j], q);
  return sum;
}
template <class T>
struct SgReflectedGrad {
  T value, d_lambda, d_q;
};
template <class T>
HD SgReflectedGrad<T> sg_reflected_grad(T lambda, const ReflectionLobe<T>& lobe, T q) {
  SgReflectedGrad<T> sum{T(0.0f), T(0.0f), T(0.0f)};
  for (int j = 0; j < kReflectionLobes; ++j) {
    const SgInnerGrad<T> s = sg_inner_grad(lambda, lobe.lambda[j], q);
    sum.value += lobe.weight[j] * s.value;
    sum.d_lambda += lobe.weight[j] * s.d_lambda1;
    sum.d_q += lobe.weight[j] * s.d_q;
  }
  return sum;
}
// Derivatives by q and by the roughness that the lobe was made for.
template <class T>
struct SgReflectedMaterialGrad {
  T d_q, d_roughness;
};
template <class T>
HD SgReflectedMaterialGrad<T> sg_reflected_material_grad(T lambda, const ReflectionLobeGrad<T>& g, T q) {
  SgReflectedMaterialGrad<T> sum{T(0.0f), T(0.0f)};
  for (int j = 0; j < kReflectionLobes; ++j) {
    const SgInnerGrad<T> s = sg_inner_grad(lambda, g.lobe.lambda[j], q);
    sum.d_q += g.lobe.weight[j] * s.d_q;
    sum.d_roughness += g.d_weight[j] * s.value + g.lobe.weight[j] * s.d_lambda2 * g.d_lambda[j];
  }
  return sum;
}

}  // namespace cei3d
