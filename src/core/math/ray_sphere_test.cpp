// SPDX-License-Identifier: Apache-2.0
#include "core/math/ray_sphere.h"

#include <gtest/gtest.h>

#include "core/math/dual.h"
#include "core/math/rng.h"

namespace cei3d {
namespace {

constexpr double kRadius = 0.8;

struct Line {
  Vec3d origin, direction;
};

// A ray that starts in the cube of half-width 1.2 around the center.
Line random_line(uint64_t i) {
  Rng rng(7, 0, i);
  const auto coordinate = [&] { return 2.0 * double(rng.uniform()) - 1; };
  const auto vector = [&] { return Vec3d{coordinate(), coordinate(), coordinate()}; };
  const Vec3d origin = vector() * 1.2;
  return {origin, normalize(vector())};
}

// Brute force: the first and the last of many points of the ray that lie in the sphere.
TEST(RaySphere, SpansThePointsOfTheRayInTheSphere) {
  constexpr double kStep = 1e-3;
  int missed = 0, inside = 0;
  for (uint64_t i = 0; i < 500; ++i) {
    const Line l = random_line(i);
    double first = -1, last = -1;
    for (double t = 0; t < 3; t += kStep)
      if (length(l.origin + l.direction * t) < kRadius) {
        if (first < 0) first = t;
        last = t;
      }
    const SphereSpan<double> span = sphere_span(l.origin, l.direction, kRadius);
    if (first < 0) {
      EXPECT_LT(span.far - span.near, 2 * kStep) << i;  // or it only touches the sphere
      ++missed;
      continue;
    }
    EXPECT_NEAR(span.near, first, 1.01 * kStep) << i;
    EXPECT_NEAR(span.far, last, 1.01 * kStep) << i;
    inside += span.near == 0;
  }
  EXPECT_GT(missed, 100);
  EXPECT_GT(inside, 30);
}

TEST(RaySphere, ARayThatLeavesOrPassesItHasNoSpan) {
  const auto is_empty = [](Vec3f origin, Vec3f direction) {
    const SphereSpan<float> span = sphere_span(Ray{origin, direction}, 0.5f);
    return !(span.near < span.far);
  };
  EXPECT_TRUE(is_empty({0, 0, 2}, {0, 0, 1}));
  EXPECT_TRUE(is_empty({0, 0.6f, 2}, {0, 0, -1}));
  EXPECT_TRUE(is_empty({0, 0.5f, 2}, {0, 0, -1}));  // touches it
  EXPECT_TRUE(is_empty({NAN, 0, 2}, {0, 0, -1}));
  EXPECT_FALSE(is_empty({0, 0.4f, 2}, {0, 0, -1}));
}

// A point of the ray that stays on the sphere while the radius grows moves by r / (p . d).
TEST(RaySphere, MovesWithTheRadius) {
  using D = Dual<double>;
  const Vec3d origin{0.3, -0.2, 3}, direction = normalize(Vec3d{-0.05, 0.1, -1});
  const auto dual = [](Vec3d v) { return Vec3<D>{D(v.x), D(v.y), D(v.z)}; };
  const SphereSpan<D> span = sphere_span(dual(origin), dual(direction), D(kRadius, 1));
  for (const D t : {span.near, span.far})
    EXPECT_NEAR(t.derivative, kRadius / dot(origin + direction * t.value, direction), 1e-12);
}

}  // namespace
}  // namespace cei3d
