// SPDX-License-Identifier: Apache-2.0
// Rays on a sphere, whose hits are known, and on a random network against a fine search.
#include "model/geometry/shape/trace_field.h"

#include <gtest/gtest.h>

#include <cmath>

#include "core/math/rng.h"

namespace cei3d {
namespace {

constexpr float kRadius = 0.5f;

Field sphere() {
  FieldConfig c;
  c.outputs = 1;
  c.activation = Activation::softplus;
  c.sphere_radius = kRadius;
  Field field(c, 1);
  for (Param& p : field.params().all()) std::fill(p.value.begin(), p.value.end(), 0.0f);
  return field;
}

// Bumps on a sphere, with slopes of .5 to 1.5.
Field bumps() {
  FieldConfig c;
  c.outputs = 1;
  c.encoding.frequencies = 3;
  c.hidden_layers = 1;
  c.width = 32;
  c.activation = Activation::softplus;
  c.softplus_beta = 10;
  c.sphere_radius = 0.45f;
  Field field(c, 5);
  for (Param& p : field.params().all())
    for (float& v : p.value) v *= 0.5f;
  return field;
}

std::vector<Ray> rays(size_t n) {
  std::vector<Ray> out;
  for (uint64_t i = 0; i < n; ++i) {
    Rng rng(2, 0, i);
    const Vec3f o = normalize(Vec3f{rng.normal(), rng.normal(), rng.normal()}) * 2.0f,
                to = Vec3f{rng.normal(), rng.normal(), rng.normal()} * 0.4f;
    out.push_back({o, normalize(to - o)});
  }
  return out;
}

// Distance of a ray's line from the origin.
float gap(const Ray& r) { return length(r.origin - r.direction * dot(r.origin, r.direction)); }

void expect_sphere_hit(const Ray& r, const FieldTrace& found) {
  const float g = gap(r), middle = -dot(r.origin, r.direction);
  if (std::abs(g - kRadius) < 1e-3f) return;  // either is right
  EXPECT_EQ(found.hit, g < kRadius) << g;
  if (found.hit) {
    EXPECT_NEAR(found.depth, middle - std::sqrt(square(kRadius) - square(g)), 2e-5f / std::sqrt(kRadius - g));
  } else if (g < 1) {
    EXPECT_GE(found.value, g - kRadius - 1e-5f);
    EXPECT_LE(found.value, 1.2f * (g - kRadius) + 2e-3f);  // steps are as long as the distance
  }
}

TEST(TraceField, FindsASphereWithAndWithoutAStart) {
  const Device device = make_device("cpu");
  const Field field = sphere();
  const std::vector<Ray> all = rays(400);
  std::vector<float> starts;
  for (size_t i = 0; i < all.size(); ++i) {
    const float g = std::min(gap(all[i]), kRadius);
    const float depth = -dot(all[i].origin, all[i].direction) - std::sqrt(square(kRadius) - square(g));
    const float errors[] = {0, 0.004f, -0.004f, 0.3f, -0.3f};
    starts.push_back(i % 6 == 5 ? 0 : depth + errors[i % 6]);
  }
  const std::vector<FieldTrace> free = trace_field(device, field, all),
                                started = trace_field(device, field, all, starts);
  for (size_t i = 0; i < all.size(); ++i) {
    expect_sphere_hit(all[i], free[i]);
    expect_sphere_hit(all[i], started[i]);
  }
}

TEST(TraceField, RaysFromInsideHitWhereTheyBegin) {
  const Ray inside{{0.1f, 0, 0}, {0, 0, 1}};
  const FieldTrace found = trace_field(make_device("cpu"), sphere(), {&inside, 1})[0];
  EXPECT_TRUE(found.hit);
  EXPECT_EQ(found.depth, 0);
}

TEST(TraceField, RaysBesideTheUnitSphereMiss) {
  const Ray beside{{0, 1.5f, -3}, {0, 0, 1}};
  const FieldTrace found = trace_field(make_device("cpu"), sphere(), {&beside, 1})[0];
  EXPECT_FALSE(found.hit);
  EXPECT_NEAR(found.depth, 3, 1e-5);
  EXPECT_NEAR(found.value, 1, 1e-5);
}

TEST(LowestAlong, IsTheNearestPointOfARayToASphere) {
  const std::vector<Ray> all = rays(100);
  const std::vector<FieldTrace> lowest = lowest_along(make_device("cpu"), sphere(), all);
  for (size_t i = 0; i < all.size(); ++i) {
    if (gap(all[i]) > 0.95f) continue;
    EXPECT_NEAR(lowest[i].value, gap(all[i]) - kRadius, 2e-3) << i;
    EXPECT_EQ(lowest[i].hit, lowest[i].value <= 0);
  }
}

TEST(TraceField, FindsTheFirstCrossingOfARandomField) {
  const Device device = make_device("cpu");
  const Field field = bumps();
  const std::vector<Ray> all = rays(60);
  const std::vector<FieldTrace> found = trace_field(device, field, all);
  constexpr int kFine = 4000;
  int hits = 0, differ = 0;
  for (size_t i = 0; i < all.size(); ++i) {
    std::vector<Vec3f> x;
    for (int k = 0; k < kFine; ++k)
      x.push_back(all[i].origin + all[i].direction * (1 + 2.0f * float(k) / kFine));
    const std::vector<float> f = first_output(device, field, x);
    int first = 0;
    while (first < kFine && (f[size_t(first)] > 0 || length(x[size_t(first)]) > 1)) ++first;
    if ((first < kFine) != found[i].hit) {
      ++differ;
      continue;
    }
    if (!found[i].hit) continue;
    ++hits;
    EXPECT_NEAR(found[i].depth, 1 + 2.0f * float(first) / kFine, 2.1f / kFine) << i;
    EXPECT_LE(std::abs(found[i].value), 10 * kTraceTolerance);
  }
  EXPECT_GT(hits, 10);
  EXPECT_LE(differ, 1);
}

}  // namespace
}  // namespace cei3d
