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
// angle over roughness 0.1 to 0.65, hold 99.5 % of the energy. The broad ones carry the sun to points whose
// mirror direction is dark.
inline constexpr int kReflectionLobes = 5;
HD constexpr float reflection_log_node(int j) {  // of nodes .00737, .0355, .1154, .3715, 1.3242
  constexpr float kLogs[kReflectionLobes] = {-4.9110162f, -3.3382930f, -2.1592210f, -0.9902982f, 0.2808139f};
  return kLogs[j];
}
// Fraction of the energy in each.
HD constexpr float reflection_share(int j) {
  constexpr float kShares[kReflectionLobes] = {0.0267184f, 0.0805499f, 0.1724400f, 0.5452267f, 0.1750652f};
  return kShares[j];
}

// Sharpness of Gaussian j is scale * node^spread. The horizon cuts off the tails of rough surfaces, so their
// Gaussians are closer to one another: at roughness 1 there is but one. Fitted to the squared error of the
// density of the reflected light.
template <class T>
struct ReflectionShape {
  T scale, spread;
};
// Share of the long tails, 1 for smooth surfaces.
template <class T>
HD T reflection_tails(T alpha) {
  const T x = alpha * T(1 / 0.31627f), x3 = x * x * x;
  return T(1.0f) / (T(1.0f) + x3 * x3);
}
template <class T>
HD ReflectionShape<T> reflection_shape(T roughness) {
  const T alpha = roughness * roughness, tails = reflection_tails(alpha);
  return {(T(0.33878f) + T(0.79402f) * tails) / (alpha * alpha) + T(1.59705f), T(1.0693f) * tails};
}
template <class T>
HD ReflectionShape<T> reflection_shape_grad(T roughness) {  // d / d roughness
  const T two(2.0f), alpha = roughness * roughness, inverse = T(1.0f) / alpha,
                     tails = reflection_tails(alpha);
  const T d_tails = T(-6.0f) * tails * (T(1.0f) - tails) * inverse;  // by alpha
  const T d_scale =
      (T(0.79402f) * d_tails - two * (T(0.33878f) + T(0.79402f) * tails) * inverse) * (inverse * inverse);
  return {two * roughness * d_scale, two * roughness * T(1.0693f) * d_tails};
}
template <class T>
HD T reflection_sharpness(const ReflectionShape<T>& shape, int j) {
  return shape.scale * exp(shape.spread * T(reflection_log_node(j)));
}

// Tangent of half the angle between the axis and the cone about it that holds half of the energy.
template <class T>
HD T reflection_half_energy(T roughness) {
  const ReflectionShape<T> shape = reflection_shape(max(roughness, T(kMinRoughness)));
  // The sharpness times one minus the cosine, where the mixture without its part behind the axis holds half.
  const T x = exp(T(-0.36008f) + shape.spread * (T(1.19589f) + T(-0.10679f) * shape.spread));
  const T y = min(x / shape.scale, T(1.0f));
  return sqrt(y / (T(2.0f) - y));
}

// The mixture for one roughness: sharpness lambda[j], and weight[j] of unit-height Gaussians, so that the
// integral over the sphere is 1.
template <class T>
struct ReflectionLobe {
  T lambda[kReflectionLobes], weight[kReflectionLobes];
};
template <class T>
HD ReflectionLobe<T> reflection_lobe(T roughness) {
  const ReflectionShape<T> shape = reflection_shape(max(roughness, T(kMinRoughness)));
  ReflectionLobe<T> lobe;
  for (int j = 0; j < kReflectionLobes; ++j) {
    lobe.lambda[j] = reflection_sharpness(shape, j);
    lobe.weight[j] = T(reflection_share(j)) / sg_integral(lobe.lambda[j]);
  }
  return lobe;
}

// The variance along a tangent of a Gaussian with the mean sharpness of the mixture: that of its peak.
template <class T>
HD T reflection_peak_width(T roughness) {
  const ReflectionLobe<T> lobe = reflection_lobe(roughness);
  T sum(0.0f);
  for (int j = 0; j < kReflectionLobes; ++j) sum += T(reflection_share(j)) * lobe.lambda[j];
  return T(1.0f) / sum;
}

// The mixture stretched along the plane of incidence: at grazing angles the reflection of a rough surface is
// longer in that plane than across it. stretch: the ratio of the two widths, >= 1; their product is that of
// the round lobe.
template <class T>
struct StretchedLobe {
  T along[kReflectionLobes], across[kReflectionLobes], weight[kReflectionLobes];  // sharpnesses, weights
};
template <class T>
HD StretchedLobe<T> stretched_lobe(T roughness, T stretch) {
  const ReflectionLobe<T> round = reflection_lobe(roughness);
  const T shrink = T(1.0f) / stretch;
  StretchedLobe<T> lobe;
  for (int j = 0; j < kReflectionLobes; ++j) {
    lobe.along[j] = round.lambda[j] * shrink;
    lobe.across[j] = round.lambda[j] * stretch;
    lobe.weight[j] = round.weight[j];
  }
  return lobe;
}

// The adjoint of stretched_lobe(); below kMinRoughness the derivative by the roughness is 0.
template <class T>
struct LobeMaterialGrad {
  T d_roughness, d_stretch;
};
template <class T>
HD LobeMaterialGrad<T> stretched_lobe_grad(T roughness, T stretch, const StretchedLobe<T>& d) {
  const T clamped = max(roughness, T(kMinRoughness)), shrink = T(1.0f) / stretch;
  const ReflectionShape<T> shape = reflection_shape(clamped), d_shape = reflection_shape_grad(clamped);
  const T d_log_scale = d_shape.scale / shape.scale;
  const ReflectionLobe<T> round = reflection_lobe(roughness);
  LobeMaterialGrad<T> sum{T(0.0f), T(0.0f)};
  for (int j = 0; j < kReflectionLobes; ++j) {
    const T lambda = round.lambda[j],
            weight_by_lambda = -(round.weight[j] * sg_integral_grad(lambda) / sg_integral(lambda));
    const T d_lambda = d.along[j] * shrink + d.across[j] * stretch + d.weight[j] * weight_by_lambda;
    sum.d_roughness += d_lambda * lambda * (d_log_scale + d_shape.spread * T(reflection_log_node(j)));
    sum.d_stretch += lambda * (d.across[j] - d.along[j] * shrink * shrink);
  }
  sum.d_roughness = select(roughness < T(kMinRoughness), T(0.0f), sum.d_roughness);
  return sum;
}

// Radiance of a light lobe of unit height and sharpness lambda, averaged over the reflection lobe; q is the
// squared distance of the light's axis and the lobe's on the unit sphere, h its part across the plane of
// incidence.
template <class T>
HD T sg_reflected(T lambda, const StretchedLobe<T>& lobe, T q, T h) {
  T sum(0.0f);
  for (int j = 0; j < kReflectionLobes; ++j)
    sum += lobe.weight[j] * sg_stretched_inner(lambda, lobe.along[j], lobe.across[j], q, h);
  return sum;
}
template <class T>
struct SgReflectedGrad {
  T value, d_lambda, d_q, d_h;
};
template <class T>
HD SgReflectedGrad<T> sg_reflected_grad(T lambda, const StretchedLobe<T>& lobe, T q, T h) {
  SgReflectedGrad<T> sum{T(0.0f), T(0.0f), T(0.0f), T(0.0f)};
  for (int j = 0; j < kReflectionLobes; ++j) {
    const SgStretchedInnerGrad<T> s = sg_stretched_inner_grad(lambda, lobe.along[j], lobe.across[j], q, h);
    sum.value += lobe.weight[j] * s.value;
    sum.d_lambda += lobe.weight[j] * s.d_lambda1;
    sum.d_q += lobe.weight[j] * s.d_q;
    sum.d_h += lobe.weight[j] * s.d_h;
  }
  return sum;
}
// Adds `d` times the derivatives by the lobe to d_lobe. Returns `d` times those by q and h, and the value.
template <class T>
struct SgDistanceGrad {
  T value, d_q, d_h;
};
template <class T>
HD SgDistanceGrad<T> sg_reflected_lobe_grad(T lambda, const StretchedLobe<T>& lobe, T q, T h, T d,
                                            StretchedLobe<T>& d_lobe) {
  SgDistanceGrad<T> sum{T(0.0f), T(0.0f), T(0.0f)};
  for (int j = 0; j < kReflectionLobes; ++j) {
    const SgStretchedInnerGrad<T> s = sg_stretched_inner_grad(lambda, lobe.along[j], lobe.across[j], q, h);
    const T weight = d * lobe.weight[j];
    d_lobe.along[j] += weight * s.d_along;
    d_lobe.across[j] += weight * s.d_across;
    d_lobe.weight[j] += d * s.value;
    sum.value += lobe.weight[j] * s.value;
    sum.d_q += weight * s.d_q;
    sum.d_h += weight * s.d_h;
  }
  return sum;
}

}  // namespace cei3d
