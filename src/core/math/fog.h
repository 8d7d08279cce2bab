// SPDX-License-Identifier: Apache-2.0
// A ray through cells of fog of constant density and color, over white: the loss of its pixel and the
// adjoint.
#pragma once

#include "core/math/composite.h"

namespace cei3d {

template <class T>
HD T fog_opacity(T density, T length) {
  return T(1.0f) - exp(-density * length);
}

// What a pixel should look like, and the weight of its opacity against its color.
template <class T>
struct FogTarget {
  Vec3<T> color;
  T alpha, alpha_weight;
};

template <class T>
HD Composite<T> fog_ray() {
  return Composite<T>(Vec3<T>{T(1.0f), T(1.0f), T(1.0f)});
}

// |color - target|^2 / 2, and the same of the opacity, of a ray through which fog_ray() has gone.
template <class T>
HD T fog_loss(const Composite<T>& seen, const FogTarget<T>& target) {
  const Vec3<T> color = seen.pixel - target.color;
  return T(0.5f) * (dot(color, color) + target.alpha_weight * square(seen.coverage - target.alpha));
}

template <class T>
struct FogCellGrad {
  T d_density;
  Vec3<T> d_color;
};

template <class T>
class FogGrad {
 public:
  // length: of the ray in every cell.
  HD FogGrad(const Composite<T>& seen, const FogTarget<T>& target, T length)
      : length_(length),
        d_passed_(target.alpha_weight * (seen.coverage - target.alpha) * (T(1.0f) - seen.coverage)),
        colors_(fog_ray<T>().pixel, seen.pixel - target.color) {}
  // Cells back to front, each with what Composite::add gave for it. Every cell dims what passes by the same
  // share per unit of density.
  HD FogCellGrad<T> add(T opacity, const SampleWeight<T>& w, Vec3<T> color) {
    const CompositeSampleGrad<T> g = colors_.add(opacity, w, color);
    return {length_ * ((T(1.0f) - opacity) * g.d_alpha + d_passed_), g.d_color};
  }

 private:
  T length_, d_passed_;
  CompositeGrad<T> colors_;
};

}  // namespace cei3d
