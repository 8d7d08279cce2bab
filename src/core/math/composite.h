// SPDX-License-Identifier: Apache-2.0
// Front-to-back compositing of the samples of a ray, and its adjoint. Sample i has opacity alpha_i and color
// c_i; the light that reaches it is T_i = prod_{j < i} (1 - alpha_j), its weight w_i = T_i alpha_i, and
//   pixel = background + sum_i w_i (c_i - background),  coverage = sum_i w_i.
#pragma once

#include "core/math/vec.h"

namespace cei3d {

template <class T>
struct SampleWeight {
  T transmittance;  // share of the light that reaches the sample
  T weight;         // share of the sample's color in the pixel
};

// Transmittance along a ray as samples are passed front to back.
template <class T>
struct Transmittance {
  T left{1.0f};
  HD SampleWeight<T> pass(T alpha) {
    const SampleWeight<T> w{left, left * alpha};
    left = left * (T(1.0f) - alpha);
    return w;
  }
};

template <class T>
class Composite {
 public:
  HD explicit Composite(Vec3<T> background_in) : pixel(background_in), background(background_in) {}
  // Samples front to back. The adjoint needs the result.
  HD SampleWeight<T> add(T alpha, Vec3<T> color) {
    const SampleWeight<T> w = light.pass(alpha);
    pixel += (color - background) * w.weight;
    coverage = coverage + w.weight;
    return w;
  }

  Vec3<T> pixel;
  T coverage{0.0f};

 private:
  Vec3<T> background;
  Transmittance<T> light;
};

template <class T>
struct CompositeSampleGrad {
  T d_alpha;
  Vec3<T> d_color;
};

// Adjoint of Composite for a loss of the pixel with gradient d_pixel. A sample's opacity also dims all that
// lies behind it, d w_j / d alpha_i = -w_j / (1 - alpha_i) for j > i: the sum over those, of w_j dL/dw_j, is
// kept while samples come back to front.
template <class T>
class CompositeGrad {
 public:
  HD CompositeGrad(Vec3<T> background, Vec3<T> d_pixel) : background_(background), d_pixel_(d_pixel) {}
  // Samples back to front, each with what Composite::add gave for it.
  HD CompositeSampleGrad<T> add(T alpha, const SampleWeight<T>& w, Vec3<T> color) {
    const T d_weight = dot(d_pixel_, color - background_);
    // At an opacity of one no sample behind has weight; the floor keeps the quotient finite.
    const T d_alpha = w.transmittance * d_weight - behind_ / max(T(1.0f) - alpha, T(1e-4f));
    behind_ = behind_ + w.weight * d_weight;
    return {d_alpha, d_pixel_ * w.weight};
  }

 private:
  Vec3<T> background_, d_pixel_;
  T behind_{0.0f};
};

}  // namespace cei3d
