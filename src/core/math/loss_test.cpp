// SPDX-License-Identifier: Apache-2.0
// Hand-written gradients of losses against dual numbers.
#include "core/math/loss.h"

#include <gtest/gtest.h>

#include <cmath>

#include "core/math/dual.h"

namespace cei3d {
namespace {

using D = Dual<double>;

// Expects the gradient of loss(Vec3<T>) at g to equal that of dual numbers.
template <class Loss>
void expect_gradient(Vec3<double> g, const Loss& loss) {
  const Vec3<double> gradient = loss(g).gradient;
  for (int k = 0; k < 3; ++k) {
    Vec3<D> x{D(g.x), D(g.y), D(g.z)};
    x[k].derivative = 1;
    EXPECT_NEAR(gradient[k], loss(x).value.derivative, 1e-9) << "component " << k;
    EXPECT_EQ(loss(x).value.value, loss(g).value);
  }
}

constexpr double kErrors[] = {-0.2, -0.01, 0.03, 0.4};  // on both sides of zero and of the width

TEST(Huber, GradientEqualsDualNumbers) {
  for (double e : kErrors)
    EXPECT_NEAR(huber(e, 0.05).gradient, huber(D(e, 1), D(0.05)).value.derivative, 1e-12);
}

TEST(Huber, OfAColorIsTheSumOverItsChannels) {
  for (double e : kErrors) {
    const Vec3<double> error{e, 0.02, -0.3};
    expect_gradient(error, [](auto v) { return huber(v, decltype(v.x)(0.05)); });
    EXPECT_DOUBLE_EQ(huber(error, 0.05).value,
                     huber(e, 0.05).value + huber(0.02, 0.05).value + huber(-0.3, 0.05).value);
  }
}

TEST(Huber, WeightIsTheGradientOverTheError) {
  for (double e : kErrors) EXPECT_NEAR(huber_weight(e, 0.05) * e / 0.05, huber(e, 0.05).gradient, 1e-12);
  EXPECT_EQ(huber_weight(0.0, 0.05), 1);
}

TEST(Absolute, GradientEqualsDualNumbersAndIsZeroAtZero) {
  for (double e : kErrors) EXPECT_EQ(absolute(e).gradient, absolute(D(e, 1)).value.derivative);
  EXPECT_EQ(absolute(0.0).gradient, 0);
}

// Expects the gradient of loss(T radiance, T photo, bool clipped) to equal that of dual numbers, and a
// clipped channel to pull up only.
template <class Loss>
void expect_loss_of_radiance(const Loss& loss) {
  for (double radiance : {0.005, 0.02, 0.18, 0.21, 0.7, 1.4})
    for (double photo : {0.001, 0.2, 0.9}) {
      const LossValue<D> dual = loss(D(radiance, 1), D(photo), false);
      const double slope = dual.value.derivative;
      EXPECT_NEAR(loss(radiance, photo, false).gradient, slope, 1e-6 * (1 + std::abs(slope)))
          << radiance << ' ' << photo;
      EXPECT_EQ(loss(radiance, photo, false).value, dual.value.value);
    }
  EXPECT_EQ(loss(1.3, 1.0, true).value, 0);
  EXPECT_EQ(loss(1.3, 1.0, true).gradient, 0);
  EXPECT_GT(loss(1.3, 1.0, false).gradient, 0);
  EXPECT_LT(loss(0.6, 1.0, true).gradient, 0);
}

TEST(DisplayLoss, GradientEqualsDualNumbersAboveTheDarkest) {
  expect_loss_of_radiance([](auto... x) { return display_loss(x...); });
}

TEST(LinearLoss, GradientEqualsDualNumbers) {
  expect_loss_of_radiance([](auto... x) { return linear_loss(x...); });
}

TEST(DisplayLoss, HasTheSlopeOfTheDarkestBelowIt) {
  const double smallest = display_loss(1e-4, 0.9).gradient;
  EXPECT_DOUBLE_EQ(display_loss(0.0039, 0.9).gradient, smallest);
  EXPECT_DOUBLE_EQ(display_loss(-0.1, 0.9).gradient, smallest);
  EXPECT_LT(smallest, display_loss(0.0041, 0.9).gradient);
}

TEST(CrossEntropy, GradientEqualsDualNumbers) {
  for (double y : {1e-3, 0.2, 0.5, 0.999})
    for (double wanted : {0.0, 0.3, 1.0}) {
      const LossValue<D> dual = cross_entropy(D(y, 1), D(wanted));
      EXPECT_NEAR(cross_entropy(y, wanted).gradient, dual.value.derivative,
                  1e-9 * std::abs(dual.value.derivative) + 1e-9);
    }
}

TEST(CrossEntropy, BehindASigmoidHasTheErrorAsGradientAndIsFiniteAtTheEdges) {
  for (double z : {-6.0, -0.5, 0.0, 2.0}) {
    const ActivationValue<double> y = Sigmoid::eval(z, 0);
    EXPECT_NEAR(cross_entropy(y.value, 0.3).gradient * y.first, y.value - 0.3, 1e-9);
  }
  for (float y : {0.0f, 1.0f}) {
    EXPECT_TRUE(std::isfinite(cross_entropy(y, 0.3f).value));
    EXPECT_TRUE(std::isfinite(cross_entropy(y, 0.3f).gradient));
  }
}

TEST(Eikonal, GradientEqualsDualNumbers) {
  for (double e : kErrors) expect_gradient({0.3 + e, -0.8, 0.1}, [](auto g) { return eikonal(g); });
}

TEST(Eikonal, IsMinimalForUnitGradients) {
  const auto unit = eikonal(Vec3<double>{0.6, 0, -0.8});
  EXPECT_NEAR(unit.value, 0, 1e-12);
  EXPECT_NEAR(length(unit.gradient), 0, 1e-6);
}

TEST(EmptyPush, GradientEqualsDualNumbers) {
  for (double sdf : {-0.1, -0.004, 1e-6, 0.002, 0.05}) {
    const auto v = empty_push(sdf, 200);
    EXPECT_NEAR(v.gradient, empty_push(D(sdf, 1), 200).value.derivative, 1e-9) << sdf;
  }
}

TEST(CoverPull, GradientEqualsDualNumbersAndMirrorsThatOfEmptyPush) {
  for (double sdf : {-0.1, -0.004, 1e-6, 0.002, 0.05}) {
    const auto v = cover_pull(sdf, 200);
    EXPECT_NEAR(v.gradient, cover_pull(D(sdf, 1), 200).value.derivative, 1e-9) << sdf;
    EXPECT_NEAR(v.value, empty_push(-sdf, 200).value, 1e-12);
  }
}

TEST(EmptyPush, PushesWithFullStrengthFromDeepInsideAndNotAtAllFarOutside) {
  EXPECT_NEAR(empty_push(-0.1, 400).gradient, -1, 1e-9);
  EXPECT_NEAR(empty_push(-0.1, 400).value, 0.1, 1e-9);
  EXPECT_NEAR(empty_push(0.1, 400).gradient, 0, 1e-9);
}

}  // namespace
}  // namespace cei3d
