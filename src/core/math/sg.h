// SPDX-License-Identifier: Apache-2.0
// Spherical Gaussians G(w) = mu exp(lambda (w . axis - 1)): integrals in closed form, for unit mu, and their
// derivatives. Two axes enter by their squared distance q = |axis1 - axis2|^2 = 2 (1 - cosine), which keeps
// sharp lobes accurate in single precision. [Wang et al. 2009; Meder and Bruederlin 2018;
// docs/method.md#light]
#pragma once

#include "core/math/vec.h"

namespace cei3d {

// (1 - e^-x) / x for x >= 0.
template <class T>
HD T sg_decay(T x) {
  const T small = T(1.0f) + x * (T(-0.5f) + x * (T(1.0f / 6) + x * T(-1.0f / 24)));
  return select(x < T(0.02f), small, (T(1.0f) - exp(-x)) / max(x, T(1e-6f)));
}

// Integral over the sphere.
template <class T>
HD T sg_integral(T lambda) {
  return T(4 * kPi) * sg_decay(T(2.0f) * lambda);
}
template <class T>
HD T sg_integral_grad(T lambda) {  // d / d lambda
  const T e = exp(T(-2.0f) * lambda), f = sg_integral(lambda);
  return (T(4 * kPi) * e - f) / lambda;
}

// The product of two lobes is a lobe: its sharpness and the logarithm of its peak. (Its axis is
// (lambda1 axis1 + lambda2 axis2) / lambda.)
template <class T>
struct SgProduct {
  T lambda, log_peak;
};
template <class T>
HD SgProduct<T> sg_product(T lambda1, T lambda2, T q) {
  const T sum = lambda1 + lambda2, p = lambda1 * lambda2 * q;
  const T lambda = sqrt(max(sum * sum - p, T(1e-12f)));
  return {lambda, -p / (sum + lambda)};
}

// Integral over the sphere of the product of two lobes.
template <class T>
HD T sg_inner(T lambda1, T lambda2, T q) {
  const SgProduct<T> p = sg_product(lambda1, lambda2, q);
  return exp(p.log_peak) * sg_integral(p.lambda);
}
template <class T>
struct SgInnerGrad {
  T value, d_lambda1, d_lambda2, d_q;
};
template <class T>
HD SgInnerGrad<T> sg_inner_grad(T lambda1, T lambda2, T q) {
  const SgProduct<T> p = sg_product(lambda1, lambda2, q);
  const T peak = exp(p.log_peak), integral = sg_integral(p.lambda);
  const T value = peak * integral;
  // With n = lambda of the product: log_peak = n - lambda1 - lambda2, dn/dlambda1 = (lambda1 + lambda2 -
  // lambda2 q / 2) / n, dn/dq = -lambda1 lambda2 / (2 n).
  const T sum = lambda1 + lambda2, d_n = value + peak * sg_integral_grad(p.lambda);
  const T half = T(0.5f) * q, inverse = T(1.0f) / p.lambda;
  return {value, d_n * (sum - lambda2 * half) * inverse - value,
          d_n * (sum - lambda1 * half) * inverse - value, d_n * (T(-0.5f) * lambda1 * lambda2 * inverse)};
}

// Integral over the sphere of the product of a round lobe and a stretched one. The stretched lobe has another
// sharpness along its long side than across it. h is the squared distance of the axes across the long side,
// h <= q. For small angles the product is that of two Gaussians in the plane: it acts like a round lobe of
// sharpness `round` at the squared distance `q`. [as for anisotropic Gaussians, Xu et al. 2013]
template <class T>
struct SgRounded {
  T round, q;
  T along_sum, across_sum, root;  // lambda1 + along, lambda1 + across, the root of their product
};
template <class T>
HD SgRounded<T> sg_rounded(T lambda1, T along, T across, T q, T h) {
  const T a = lambda1 + along, c = lambda1 + across, root = sqrt(a * c);
  const T round = (lambda1 * (along + across) + along * across) / (root + lambda1);  // root - lambda1
  return {round, (along * c * (q - h) + across * a * h) / (root * round), a, c, root};
}
template <class T>
HD T sg_stretched_inner(T lambda1, T along, T across, T q, T h) {
  const SgRounded<T> r = sg_rounded(lambda1, along, across, q, h);
  return sg_inner(lambda1, r.round, r.q);
}
template <class T>
struct SgStretchedInnerGrad {
  T value, d_lambda1, d_along, d_across, d_q, d_h;
};
template <class T>
HD SgStretchedInnerGrad<T> sg_stretched_inner_grad(T lambda1, T along, T across, T q, T h) {
  const SgRounded<T> r = sg_rounded(lambda1, along, across, q, h);
  const SgInnerGrad<T> g = sg_inner_grad(lambda1, r.round, r.q);
  const T a = r.along_sum, c = r.across_sum, gap = q - h, inverse = T(1.0f) / (r.root * r.round);
  const T d_product = g.d_q * inverse;  // by the numerator of r.q
  const T d_round = g.d_lambda2 - g.d_q * r.q * r.root * inverse;
  const T d_root = (d_round - g.d_q * r.q * r.round * inverse) * T(0.5f) / r.root;
  const T d_a = d_root * c + d_product * across * h, d_c = d_root * a + d_product * along * gap;
  return {g.value,
          g.d_lambda1 - d_round + d_a + d_c,
          d_a + d_product * c * gap,
          d_c + d_product * a * h,
          d_product * along * c,
          d_product * (across * a - along * c)};
}

// Integral over the hemisphere around a normal at cosine c to the axis, lambda >= 0.02: a fit that blends the
// integrals over the hemispheres around the axis and against it by s = (1 + tanh(t c / 2) / tanh(t / 2)) / 2.
template <class T>
struct SgCosineGrad {
  T value, d_lambda, d_cosine;
};
template <class T>
HD SgCosineGrad<T> sg_hemisphere_grad(T lambda, T c) {
  const T root = sqrt(lambda), inverse = T(1.0f) / lambda;
  const T up = T(1.6988f) + T(10.8438f) * inverse,
          down = T(1.0f) + inverse * (T(6.2201f) + T(10.2415f) * inverse);
  const T t = root * up / down;
  const T d_t = t * (T(0.5f) * inverse - T(10.8438f) * inverse * inverse / up +
                     inverse * inverse * (T(6.2201f) + T(20.483f) * inverse) / down);
  const T a = exp(-t), x = abs(t * c), b = exp(-x);
  const T tanh_c = select(c < T(0.0f), T(-1.0f), T(1.0f)) * (T(1.0f) - b) / (T(1.0f) + b);
  const T tanh_1 = (T(1.0f) - a) / (T(1.0f) + a);
  const T s = T(0.5f) + T(0.5f) * tanh_c / tanh_1;
  const T d_tanh_c = T(0.5f) * (T(1.0f) - tanh_c * tanh_c), d_tanh_1 = T(0.5f) * (T(1.0f) - tanh_1 * tanh_1);
  const T d_s_t = T(0.5f) * (d_tanh_c * c - tanh_c / tanh_1 * d_tanh_1) / tanh_1;
  const T d_s_c = T(0.5f) * d_tanh_c * t / tanh_1;
  const T e = exp(-lambda), full = T(2 * kPi) * sg_decay(lambda), blend = e + s * (T(1.0f) - e);
  const T d_full = (T(2 * kPi) * e - full) * inverse;
  return {full * blend, d_full * blend + full * (-e * (T(1.0f) - s) + (T(1.0f) - e) * d_s_t * d_t),
          full * (T(1.0f) - e) * d_s_c};
}
template <class T>
HD T sg_hemisphere(T lambda, T c) {
  const T root = sqrt(lambda), inverse = T(1.0f) / lambda;
  const T t = root * (T(1.6988f) + T(10.8438f) * inverse) /
              (T(1.0f) + inverse * (T(6.2201f) + T(10.2415f) * inverse));
  const T a = exp(-t), b = exp(-abs(t * c));
  const T sign = select(c < T(0.0f), T(-1.0f), T(1.0f));
  const T s = T(0.5f) + T(0.5f) * sign * (T(1.0f) - b) * (T(1.0f) + a) / ((T(1.0f) + b) * (T(1.0f) - a));
  const T e = exp(-lambda);
  return T(2 * kPi) * sg_decay(lambda) * (e + s * (T(1.0f) - e));
}

// The clamped cosine as one lobe minus a constant: max(n . w, 0) ~ kCosinePeak G(w; n, kCosineLambda) -
// kCosineFloor, within 0.008.
inline constexpr float kCosineLambda = 0.0315f, kCosinePeak = 32.7080f, kCosineFloor = 31.7003f;

// Irradiance of a surface whose normal has cosine c to the axis: integral of G(w) max(n . w, 0), lambda >=
// 0.1. Within 1.2 % of the value at c = 1; may be slightly negative beyond the horizon. Single precision at
// least: a difference of two numbers 32 times larger.
template <class T>
HD T sg_irradiance(T lambda, T c) {
  const T l2(kCosineLambda), q = T(2.0f) * (T(1.0f) - c);
  const SgProduct<T> p = sg_product(lambda, l2, q);
  const T cp = (lambda * c + l2) / p.lambda;
  return T(kCosinePeak) * exp(p.log_peak) * sg_hemisphere(p.lambda, cp) -
         T(kCosineFloor) * sg_hemisphere(lambda, c);
}
template <class T>
HD SgCosineGrad<T> sg_irradiance_grad(T lambda, T c) {
  const T l2(kCosineLambda), q = T(2.0f) * (T(1.0f) - c);
  const SgProduct<T> p = sg_product(lambda, l2, q);
  const T n = p.lambda, cp = (lambda * c + l2) / n;
  const SgCosineGrad<T> over = sg_hemisphere_grad(n, cp), under = sg_hemisphere_grad(lambda, c);
  const T peak = T(kCosinePeak) * exp(p.log_peak);
  const T n_lambda = (lambda + l2 * c) / n, n_c = lambda * l2 / n;  // dn/dlambda, dn/dc
  const T cp_lambda = (c - cp * n_lambda) / n, cp_c = (lambda - cp * n_c) / n;
  return {peak * over.value - T(kCosineFloor) * under.value,
          peak * (over.value * (n_lambda - T(1.0f)) + over.d_lambda * n_lambda + over.d_cosine * cp_lambda) -
              T(kCosineFloor) * under.d_lambda,
          peak * (over.value * n_c + over.d_lambda * n_c + over.d_cosine * cp_c) -
              T(kCosineFloor) * under.d_cosine};
}

}  // namespace cei3d
