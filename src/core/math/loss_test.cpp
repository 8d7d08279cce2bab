// SPDX-License-Identifier: Apache-2.0
// Hand-written gradients of losses against dual numbers.
#include "core/math/loss.h"

#include <gtest/gtest.h>

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
