// SPDX-License-Identifier: Apache-2.0
// Compositing against closed forms, its adjoint against dual numbers.
#include "core/math/composite.h"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "core/math/dual.h"
#include "core/math/rng.h"

namespace cei3d {
namespace {

using D = Dual<double>;

template <class T>
struct Samples {
  std::vector<T> alpha;
  std::vector<Vec3<T>> color;
};

constexpr int kSamples = 7;
const Vec3d kBackground{0.9, 0.2, 0.6}, kPixelGrad{0.7, -1.3, 0.4};

Samples<double> random_samples() {
  Samples<double> s;
  Rng rng(1, 2, 3);
  for (int i = 0; i < kSamples; ++i) {
    s.alpha.push_back(0.95 * rng.uniform());
    s.color.push_back({rng.uniform(), rng.uniform(), rng.uniform()});
  }
  return s;
}

template <class T>
Composite<T> composite(const Samples<T>& s, std::vector<SampleWeight<T>>* weights = nullptr) {
  Composite<T> out({T(kBackground.x), T(kBackground.y), T(kBackground.z)});
  for (size_t i = 0; i < s.alpha.size(); ++i) {
    const SampleWeight<T> w = out.add(s.alpha[i], s.color[i]);
    if (weights) weights->push_back(w);
  }
  return out;
}

std::vector<CompositeSampleGrad<double>> adjoint(const Samples<double>& s) {
  std::vector<SampleWeight<double>> weights;
  composite(s, &weights);
  std::vector<CompositeSampleGrad<double>> out(s.alpha.size());
  CompositeGrad<double> grad(kBackground, kPixelGrad);
  for (size_t i = s.alpha.size(); i-- > 0;) out[i] = grad.add(s.alpha[i], weights[i], s.color[i]);
  return out;
}

// The derivative of kPixelGrad . pixel by one number of sample i, which `set` marks.
template <class Set>
double by_dual_numbers(const Samples<double>& s, const Set& set) {
  Samples<D> d;
  for (size_t i = 0; i < s.alpha.size(); ++i) {
    d.alpha.push_back(D(s.alpha[i]));
    d.color.push_back({D(s.color[i].x), D(s.color[i].y), D(s.color[i].z)});
  }
  set(d).derivative = 1;
  const Vec3<D> pixel = composite(d).pixel;
  return kPixelGrad.x * pixel.x.derivative + kPixelGrad.y * pixel.y.derivative +
         kPixelGrad.z * pixel.z.derivative;
}

TEST(Composite, AdjointEqualsDualNumbers) {
  const Samples<double> s = random_samples();
  const auto grad = adjoint(s);
  for (size_t i = 0; i < s.alpha.size(); ++i) {
    const double by_alpha = by_dual_numbers(s, [i](Samples<D>& d) -> D& { return d.alpha[i]; });
    EXPECT_NEAR(grad[i].d_alpha, by_alpha, 1e-12) << "sample " << i;
    EXPECT_GT(std::abs(by_alpha), 1e-6);
    for (int c = 0; c < 3; ++c)
      EXPECT_NEAR(grad[i].d_color[c],
                  by_dual_numbers(s, [i, c](Samples<D>& d) -> D& { return d.color[i][c]; }), 1e-12);
  }
}

TEST(Composite, SamplesOfOneColorCoverByOneMinusTheProductOfWhatTheyLetThrough) {
  Samples<double> s = random_samples();
  const Vec3d color{0.1, 0.5, 0.3};
  double through = 1;
  for (double a : s.alpha) through *= 1 - a;
  std::fill(s.color.begin(), s.color.end(), color);
  const Composite<double> out = composite(s);
  EXPECT_NEAR(out.coverage, 1 - through, 1e-12);
  for (int c = 0; c < 3; ++c)
    EXPECT_NEAR(out.pixel[c], color[c] * (1 - through) + kBackground[c] * through, 1e-12);
}

TEST(Composite, WithoutSamplesShowsTheBackground) {
  const Composite<double> out = composite(Samples<double>{});
  EXPECT_EQ(out.coverage, 0);
  for (int c = 0; c < 3; ++c) EXPECT_EQ(out.pixel[c], kBackground[c]);
}

TEST(Composite, AnOpaqueSampleHidesWhatIsBehindItAndItsAdjointIsFinite) {
  Samples<double> s = random_samples();
  s.alpha[3] = 1;
  const auto grad = adjoint(s);
  for (size_t i = 4; i < s.alpha.size(); ++i) {
    EXPECT_EQ(grad[i].d_alpha, 0);
    EXPECT_EQ(length(grad[i].d_color), 0);
  }
  for (size_t i = 0; i < 3; ++i)
    EXPECT_NEAR(grad[i].d_alpha, by_dual_numbers(s, [i](Samples<D>& d) -> D& { return d.alpha[i]; }), 1e-12);
  EXPECT_TRUE(std::isfinite(grad[3].d_alpha));
}

}  // namespace
}  // namespace cei3d
