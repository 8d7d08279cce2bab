// SPDX-License-Identifier: Apache-2.0
// Hits as functions of the parameters of a sphere, a torus and a random smooth field: against dual numbers,
// and against hits that are traced again with other parameters.
#include "core/math/field_hit.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <vector>

#include "core/math/dual.h"
#include "core/math/rng.h"

namespace cei3d {
namespace {

using D = Dual<double>;
using Params = std::vector<double>;

// Fields f(x; p). Each of the first `count` parameters is varied.
struct Sphere {  // center and radius
  static constexpr int count = 4;
  static Params params() { return {0.1, -0.05, 0.2, 0.6}; }
  template <class T>
  static T at(Vec3<T> x, const std::vector<T>& p) {
    return length(x - Vec3<T>{p[0], p[1], p[2]}) - p[3];
  }
};
struct Torus {  // radii
  static constexpr int count = 2;
  static Params params() { return {0.5, 0.2}; }
  template <class T>
  static T at(Vec3<T> x, const std::vector<T>& p) {
    const T ring = sqrt(x.x * x.x + x.y * x.y) - p[0];
    return sqrt(ring * ring + x.z * x.z) - p[1];
  }
};
struct Waves {  // amplitudes of waves in random directions, on a sphere; no distance field
  static constexpr int count = 6;
  static Params params() {
    Params p;
    for (uint64_t k = 0; k < count; ++k) p.push_back(0.08 * Rng(3, 0, k).normal());
    return p;
  }
  template <class T>
  static T at(Vec3<T> x, const std::vector<T>& p) {
    T sum = length(x) * T(1.3) - T(0.75);
    for (uint64_t k = 0; k < count; ++k) {
      Rng rng(4, 0, k);
      const Vec3<T> w{T(3.0 * rng.normal()), T(3.0 * rng.normal()), T(3.0 * rng.normal())};
      sum += p[k] * sin(dot(w, x) + T(double(k)));
    }
    return sum;
  }
};

template <class F>
double value(Vec3d x, const Params& p) {
  return F::template at<double>(x, p);
}

// By dual numbers.
template <class F>
Vec3d gradient(Vec3d x, const Params& p) {
  const std::vector<D> params(p.begin(), p.end());
  Vec3d g{};
  for (int c = 0; c < 3; ++c) {
    Vec3<D> q{D(x.x), D(x.y), D(x.z)};
    q[c].derivative = 1;
    g[c] = F::template at<D>(q, params).derivative;
  }
  return g;
}

struct Ray {
  Vec3d origin, direction;
};
Ray ray_of(uint64_t i) {
  Rng rng(1, 0, i);
  const Vec3f o = normalize(Vec3f{rng.normal(), rng.normal(), rng.normal()}) * 2.5f;
  const Vec3f target = Vec3f{rng.normal(), rng.normal(), rng.normal()} * 0.3f;
  return {to_double(o), normalize(to_double(target - o))};
}

// Depth of the first zero: fine steps, then bisection to the last bit; < 0: none.
template <class F>
double trace(const Ray& r, const Params& p) {
  const auto at = [&](double t) { return value<F>(r.origin + r.direction * t, p); };
  constexpr double kStep = 0.005;
  for (double t = 1; t < 4; t += kStep) {
    if (at(t + kStep) > 0) continue;
    double lo = t, hi = t + kStep;
    for (int k = 0; k < 60; ++k) (at((lo + hi) / 2) > 0 ? lo : hi) = (lo + hi) / 2;
    return (lo + hi) / 2;
  }
  return -1;
}

// Weights of depth, position and normal in a loss.
struct Weights {
  double depth = 0.7;
  Vec3d position{0.3, -0.5, 0.2}, normal{-0.4, 0.6, 0.9};
  template <class T>
  T loss(const FieldHit<T>& h) const {
    const auto of = [](Vec3d v) { return Vec3<T>{T(v.x), T(v.y), T(v.z)}; };
    return T(depth) * h.depth + dot(of(position), h.position) + dot(of(normal), h.normal);
  }
  FieldHit<double> gradient() const { return {depth, position, normal}; }
};

// The loss of the hit that is traced with parameters p.
template <class F>
double traced_loss(const Ray& r, const Params& p) {
  const double t = trace<F>(r, p);
  const Vec3d x = r.origin + r.direction * t;
  return Weights().loss<double>({t, x, normalize(gradient<F>(x, p))});
}

template <class F>
TracedHit<double> hit_at(const Ray& r, const Params& p, double t) {
  const Vec3d x = r.origin + r.direction * t;
  constexpr double kStep = 1e-4;
  const Vec3d along =
      (gradient<F>(x + r.direction * kStep, p) - gradient<F>(x - r.direction * kStep, p)) / (2 * kStep);
  return {t, x, r.direction, value<F>(x, p), gradient<F>(x, p), along};
}

// The value and the gradient of the field at x as dual numbers by parameter k.
template <class F>
TracedHit<D> dual_hit(const TracedHit<double>& h, const Params& p, int k) {
  const auto constant = [](Vec3d v) { return Vec3<D>{D(v.x), D(v.y), D(v.z)}; };
  TracedHit<D> out{D(h.depth), constant(h.position),      constant(h.direction), {},
                   {},         constant(h.gradient_along)};
  using S = Dual<D>;  // by a coordinate, by the parameter
  std::vector<S> params;
  for (size_t j = 0; j < p.size(); ++j) params.push_back(S(D(p[j], int(j) == k ? 1.0 : 0.0), D(0.0)));
  for (int c = 0; c < 3; ++c) {
    Vec3<S> x{S(h.position.x), S(h.position.y), S(h.position.z)};
    x[c].derivative = D(1.0);
    const S f = F::template at<S>(x, params);
    out.value = f.value;
    out.gradient[c] = f.derivative;
  }
  return out;
}

template <class F>
void check_field() {
  const Params p = F::params();
  int hits = 0;
  for (uint64_t i = 0; i < 60; ++i) {
    const Ray r = ray_of(i);
    const double t = trace<F>(r, p);
    if (t < 0) continue;
    const TracedHit<double> h = hit_at<F>(r, p, t);
    if (dot(normalize(h.gradient), r.direction) > -0.25) continue;  // grazing rays: below
    ++hits;
    const TracedHitGrad<double> adjoint = field_hit_grad(h, Weights().gradient());
    for (int k = 0; k < F::count; ++k) {
      const TracedHit<D> dual = dual_hit<F>(h, p, k);
      const double by_adjoint = adjoint.d_value * dual.value.derivative +
                                adjoint.d_gradient.x * dual.gradient.x.derivative +
                                adjoint.d_gradient.y * dual.gradient.y.derivative +
                                adjoint.d_gradient.z * dual.gradient.z.derivative;
      const double by_dual = Weights().loss(field_hit(dual)).derivative;
      EXPECT_NEAR(by_adjoint, by_dual, 1e-6 * (1 + std::abs(by_dual))) << "ray " << i << " parameter " << k;
      Params more = p, less = p;
      constexpr double kStep = 1e-5;
      more[size_t(k)] += kStep, less[size_t(k)] -= kStep;
      const double traced = (traced_loss<F>(r, more) - traced_loss<F>(r, less)) / (2 * kStep);
      EXPECT_NEAR(by_adjoint, traced, 1e-4 * (1 + std::abs(traced))) << "ray " << i << " parameter " << k;
    }
  }
  EXPECT_GT(hits, 15);
}

TEST(FieldHit, OfASphereFollowsItsCenterAndRadius) { check_field<Sphere>(); }
TEST(FieldHit, OfATorusFollowsItsRadii) { check_field<Torus>(); }
TEST(FieldHit, OfASmoothFieldFollowsItsParameters) { check_field<Waves>(); }

TEST(FieldHit, ValueIsANewtonStepOntoTheSurface) {
  const Params p = Torus::params();
  for (uint64_t i = 0; i < 20; ++i) {
    const Ray r = ray_of(i);
    const double t = trace<Torus>(r, p);
    if (t < 0) continue;
    TracedHit<double> h = hit_at<Torus>(r, p, t + 1e-4);
    if (dot(normalize(h.gradient), r.direction) > -0.5) continue;
    EXPECT_NEAR(field_hit(h).depth, t, 1e-7);
    EXPECT_NEAR(length(field_hit(h).normal - normalize(gradient<Torus>(r.origin + r.direction * t, p))), 0,
                1e-6);
  }
}

// The bound of the derivative, and its sign: a larger object is met earlier, also by a ray that leaves it.
TEST(FieldHit, DerivativeOfGrazingRaysIsBounded) {
  for (const double cosine : {-0.5, -0.11, -0.05, -1e-4, 0.0, 0.3}) {
    const Vec3d n{0, 0, 1}, d{std::sqrt(1 - cosine * cosine), 0, cosine};
    const TracedHit<double> h{1, {0, 0, 0}, d, 0, n * 2.0, {0, 0, 0}};
    const double d_value = field_hit_grad(h, {1, {0, 0, 0}, {0, 0, 0}}).d_value;
    EXPECT_GT(d_value, 0);
    EXPECT_NEAR(d_value, 1 / (2 * std::max(-cosine, double(kGrazingCosine))), 1e-6);
  }
}

}  // namespace
}  // namespace cei3d
