// SPDX-License-Identifier: Apache-2.0
#include "engine/synthetic/body.h"

#include <gtest/gtest.h>

#include <cmath>
#include <map>

#include "core/base/error.h"
#include "core/math/rng.h"
#include "engine/synthetic/body_mesh.h"
#include "engine/synthetic/shapes.h"
#include "engine/synthetic/teapot.h"

namespace cei3d {
namespace {

Vec3f random_vector(Rng& rng) { return {rng.normal(), rng.normal(), rng.normal()}; }

// From 3 away towards somewhere near the origin.
Ray random_ray(uint64_t i) {
  Rng rng(5, 0, i);
  const Vec3f eye = normalize(random_vector(rng)) * 3.0f, target = random_vector(rng) * 0.4f;
  return {eye, normalize(target - eye)};
}

TEST(Body, RaysMeetABallWhereTheQuadraticFormulaSays) {
  const Shape ball = ball_shape(0.7f);
  int hits = 0;
  for (uint64_t i = 0; i < 2000; ++i) {
    const Ray ray = random_ray(i);
    const Vec3d o = to_double(ray.origin), d = to_double(ray.direction);
    const double b = dot(o, d), inside = b * b - dot(o, o) + 0.49;
    if (std::abs(inside) < 2e-3) continue;  // grazing: a ray may touch from kTouch away
    const float t = ball.body->cast(ray);
    ASSERT_EQ(t >= 0, inside > 0) << i;
    ASSERT_EQ(t >= 0, ball.body->passes_within(ray, 0)) << i;
    if (inside < 0.05) continue;  // nearly grazing: a little less exact
    ++hits;
    EXPECT_NEAR(t, -b - std::sqrt(inside), 1e-5) << i;
  }
  EXPECT_GT(hits, 500);
}

TEST(Body, ARayPassesWithinADistanceIfItMeetsTheThickerBody) {
  const Shape thin = ball_shape(0.5f), thick = ball_shape(0.6f);
  for (uint64_t i = 0; i < 1000; ++i) {
    const Ray ray = random_ray(i);
    EXPECT_EQ(thin.body->passes_within(ray, 0.1f), thick.body->passes_within(ray, 0)) << i;
  }
}

// The gradient by dual numbers against differences in double precision.
template <class Distance>
void expect_exact_normals(const Body& body, Distance distance) {
  int hits = 0;
  for (uint64_t i = 0; i < 500; ++i) {
    const Ray ray = random_ray(i);
    const float t = body.cast(ray);
    if (t < 0) continue;
    const Vec3f p = ray.origin + ray.direction * t;
    if (dot(body.normal(p), ray.direction) > -0.1f) continue;  // grazing: as for the ball
    Vec3d slope;
    for (int k = 0; k < 3; ++k) {
      Vec3d up = to_double(p), down = up;
      up[k] += 1e-6, down[k] -= 1e-6;
      slope[k] = (distance(up) - distance(down)) / 2e-6;
    }
    ++hits;
    EXPECT_NEAR(body.distance(p), 0, 1e-5);
    EXPECT_LT(length(to_double(body.normal(p)) - normalize(slope)), 2e-3) << i;
  }
  EXPECT_GT(hits, 100);
}

TEST(Body, NormalsAreTheSlopesOfTheDistance) {
  expect_exact_normals(*box_shape().body, BoxDistance());
  expect_exact_normals(*teapot_shape().body, TeapotDistance());
}

TEST(Body, NoStepOfTheDistanceGoesThroughASurface) {
  for (const std::string& name : shape_names()) {
    const Shape shape = shape_by_name(name);
    for (uint64_t i = 0; i < 20000; ++i) {
      Rng rng(7, 1, i);
      const Vec3f a = random_vector(rng) * 0.5f, b = a + random_vector(rng) * 0.1f;
      ASSERT_LE(std::abs(shape.body->distance(a) - shape.body->distance(b)), 1.0001f * length(a - b) + 1e-6f)
          << name;
    }
  }
  EXPECT_THROW(shape_by_name("cow"), Error);
}

TEST(Body, TheMeshIsClosedAndLiesOnTheSurface) {
  for (const std::string& name : shape_names()) {
    const Shape shape = shape_by_name(name);
    const Mesh mesh = body_mesh(*shape.body, 96);
    std::map<std::pair<uint32_t, uint32_t>, int> edges;
    for (const auto& t : mesh.triangles)
      for (int k = 0; k < 3; ++k) ++edges[{t[size_t(k)], t[size_t(k + 1) % 3]}];
    for (const auto& [edge, n] : edges) {
      const auto back = edges.find({edge.second, edge.first});
      ASSERT_TRUE(back != edges.end() && back->second == n) << name;
    }
    for (const Vec3f& p : mesh.positions) {
      ASSERT_NEAR(shape.body->distance(p), 0, 2e-4f) << name;
      ASSERT_LT(length(p), 0.98f) << name;
    }
  }
}

TEST(Body, EveryRegionIsSomewhereOnTheSurface) {
  for (const std::string& name : shape_names()) {
    const Shape shape = shape_by_name(name);
    std::vector<int> count(shape.regions.size(), 0);
    const Mesh mesh = body_mesh(*shape.body, 64);
    for (const Vec3f& p : mesh.positions) ++count.at(shape.region_at(p));
    for (size_t i = 0; i < count.size(); ++i)
      EXPECT_GT(count[i], int(mesh.positions.size() / 100)) << name << ' ' << shape.regions[i];
  }
}

}  // namespace
}  // namespace cei3d
