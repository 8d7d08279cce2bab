// SPDX-License-Identifier: Apache-2.0
// Pictures of known answer: furnaces, mirrors, closed forms, symmetries.
#include "engine/synthetic/path_tracer.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "core/base/parallel.h"
#include "core/math/ray_sphere.h"
#include "core/math/rng.h"
#include "core/math/sg.h"
#include "core/math/split_sum.h"
#include "engine/synthetic/picture.h"
#include "engine/synthetic/views.h"

namespace cei3d {
namespace {

SyntheticScene scene_of(Shape shape, const Finish& finish, SgMixture light) {
  SyntheticScene s;
  s.finishes.assign(shape.regions.size(), finish);
  s.shape = std::move(shape);
  s.light = std::move(light);
  s.diffuse = Diffuse::lambert;
  return s;
}
SgMixture uniform_light() { return {{{{0, 0, 1}, 0, {1, 1, 1}}}}; }

// Mean over paths.
Vec3d radiance_of(const SyntheticScene& scene, const BodyPoint& p, Vec3f to_viewer, uint32_t paths) {
  const PathTracer tracer(scene);
  Vec3d sum{0, 0, 0};
  for (uint32_t i = 0; i < paths; ++i) {
    SampleSequence samples(3, i);
    sum += to_double(tracer.radiance(p, to_viewer, samples)) / double(paths);
  }
  return sum;
}

// Points of the surface as cameras all around see them.
struct SeenPoint {
  BodyPoint point;
  Vec3f to_viewer;
};
std::vector<SeenPoint> seen_points(const SyntheticScene& scene, int n) {
  std::vector<SeenPoint> out;
  for (uint64_t i = 0; int(out.size()) < n; ++i) {
    Rng rng(2, 0, i);
    const Vec3f eye = normalize(Vec3f{rng.normal(), rng.normal(), rng.normal()}) * 3.0f;
    const Vec3f d = normalize(Vec3f{rng.normal(), rng.normal(), rng.normal()} * 0.4f - eye);
    const float t = scene.shape.body->cast({eye, d});
    if (t >= 0) out.push_back({body_point(scene, eye + d * t), -d});
  }
  return out;
}

TEST(PathTracer, AWhiteBallInAFurnaceReflectsItsReflectance) {
  const SyntheticScene scene = scene_of(ball_shape(), {{0.5f, 0.5f, 0}, {1, 1, 1}}, uniform_light());
  for (const SeenPoint& s : seen_points(scene, 20)) {
    const double nv = dot(s.point.normal, s.to_viewer);
    if (nv < 0.2) continue;
    const SplitSum<double> e = split_sum_integral(nv, 0.5);
    EXPECT_NEAR(radiance_of(scene, s.point, s.to_viewer, 4096).y, 1 + 0.04 * e.scale + e.bias, 0.01) << nv;
  }
}

// Perfect mirrors only send light on: however often it is reflected, it stays as bright as the furnace.
TEST(PathTracer, AConcaveMirrorInAFurnaceCannotBeSeen) {
  SyntheticScene scene = scene_of(teapot_shape(), {{0.1f, 0.5f, 1}, {1, 1, 1}}, uniform_light());
  scene.bounces = 16;
  for (const SeenPoint& s : seen_points(scene, 60))
    EXPECT_NEAR(radiance_of(scene, s.point, s.to_viewer, 256).y, 1, 0.05);
}

// A white matte body that sees itself stays white; without bounces its hollows are dark.
TEST(PathTracer, AConcaveWhiteBodyInAFurnaceIsWhite) {
  SyntheticScene scene = scene_of(teapot_shape(), {{1, 0, 0}, {1, 1, 1}}, uniform_light());
  double darkest[2] = {2, 2};
  for (const bool bounces : {false, true}) {
    scene.bounces = bounces ? 16 : 0;
    for (const SeenPoint& s : seen_points(scene, 60)) {
      if (dot(s.point.normal, s.to_viewer) < 0.3f) continue;
      const double got = radiance_of(scene, s.point, s.to_viewer, 256).y;
      darkest[bounces] = std::min(darkest[bounces], got);
      EXPECT_LT(got, 1.15);
    }
  }
  EXPECT_LT(darkest[0], 0.8);
  EXPECT_GT(darkest[1], 0.97);
}

TEST(PathTracer, ADiffuseBallUnderOneGaussianHasItsIrradiance) {
  for (const float lambda : {2.0f, 20.0f, 200.0f}) {
    const SgMixture light{{{normalize(Vec3f{1, 1, 2}), lambda, {2, 1, 0.5f}}}};
    const SyntheticScene scene = scene_of(ball_shape(), {{1, 0, 0}, {1, 1, 1}}, light);
    const double peak = sg_irradiance(lambda, 1.0f) / kPi;
    for (uint64_t i = 0; i < 30; ++i) {
      Rng rng(1, 1, i);
      const Vec3f n = normalize(Vec3f{rng.normal(), rng.normal(), rng.normal()});
      const BodyPoint p = body_point(scene, n * BallDistance{}.radius);
      const double truth = sg_irradiance(lambda, dot(n, light.lobes[0].axis)) / kPi;
      // Seen along the normal, where microfacets of no reflectance at right angles show least.
      const Vec3d got = radiance_of(scene, p, n, 1024);
      EXPECT_NEAR(got.y, truth, 0.025 * peak) << lambda;
      EXPECT_NEAR(got.x, 2 * got.y, 1e-3 * got.x + 1e-6);
    }
  }
}

TEST(PathTracer, AMirrorBallShowsTheLight) {
  const SgMixture light{{{{0, 0, 1}, 2, {1, 0.8f, 0.5f}}, {normalize(Vec3f{1, -1, 0}), 30, {2, 3, 4}}}};
  const SyntheticScene scene = scene_of(ball_shape(), {{0.05f, 0.5f, 1}, {1, 1, 1}}, light);
  for (const SeenPoint& s : seen_points(scene, 60)) {
    const float nv = dot(s.point.normal, s.to_viewer);
    if (nv < 0.2f) continue;
    const Vec3f mirror = s.point.normal * (2 * nv) - s.to_viewer, truth = radiance(light, mirror);
    const Vec3d got = radiance_of(scene, s.point, s.to_viewer, 256);
    for (int c = 0; c < 3; ++c) EXPECT_NEAR(got[c], truth[c], 0.02 * truth[c] + 0.02);
  }
}

TEST(Picture, TellsWhereTheBallIs) {
  const float radius = 0.8f;
  const SyntheticScene scene =
      scene_of(ball_shape(radius), {{0.5f, 0.5f, 0}, {0.2f, 0.4f, 0.6f}}, uniform_light());
  const Camera camera = look_at({2.5, -2, 1.5}, {0, 0, 0}, lens_of_size(48, 40));
  const TrueView view = draw(scene, camera, {.samples = 16});
  double covered = 0;
  for (int y = 0; y < 40; ++y)
    for (int x = 0; x < 48; ++x) {
      const float alpha = view.color.at(x, y)[3];
      covered += alpha;
      if (alpha < 1) continue;
      const Ray ray = camera.ray(x + 0.5, y + 0.5);
      const float t = sphere_span(ray, radius).near;
      const Vec3f p = ray.origin + ray.direction * t;
      const float facing = -dot(normalize(p), ray.direction);
      if (facing < 0.4f) continue;  // within a pixel the ball bends away
      EXPECT_LT(length(view.normal.rgb(x, y) - p / radius), 0.03f);
      EXPECT_NEAR(*view.depth.at(x, y), t * dot(ray.direction, camera.forward()), 0.01f);
      for (int c = 0; c < 3; ++c) EXPECT_NEAR(view.albedo.at(x, y)[c], scene.finishes[0].color[c], 1e-5);
      EXPECT_NEAR(*view.roughness.at(x, y), 0.5f, 1e-6);
      EXPECT_EQ(*view.metalness.at(x, y), 0);
    }
  // The outline of a ball at distance d is a cone of sine radius / d; its image is nearly a disc.
  const double sine = radius / length(camera.center), reach = camera.fx * sine / std::sqrt(1 - sine * sine);
  EXPECT_NEAR(covered, M_PI * reach * reach, 0.01 * covered);
}

// Mean difference of RGB times alpha: the color of a pixel that one path has met is as noisy as that path.
double mean_difference(const Image& a, const Image& b) {
  double sum = 0;
  for (size_t i = 0; i < a.data.size(); i += 4)
    for (size_t c = 0; c < 3; ++c)
      sum += std::abs(a.data[i + c] * a.data[i + 3] - b.data[i + c] * b.data[i + 3]);
  return sum / double(a.data.size() / 4 * 3);
}

TEST(Picture, IsTheSameForAnyNumberOfThreads) {
  SyntheticScene scene =
      scene_of(teapot_shape(), {{0.3f, 0.5f, 0}, {0.5f, 0.3f, 0.2f}}, light_by_name("studio"));
  const Camera camera = look_at({2.5, -2, 1.5}, {0, 0, 0}, lens_of_size(32, 32));
  const auto drawn = [&] { return draw(scene, camera, {.samples = 4}); };
  const TrueView one = Threads(1).run(drawn), five = Threads(5).run(drawn);
  EXPECT_EQ(one.color.data, five.color.data);
  EXPECT_EQ(one.normal.data, five.normal.data);
  EXPECT_GT(mean_difference(one.color, draw(scene, camera, {.samples = 4, .seed = 2}).color), 1e-3);
}

// A quarter turn of the table brings a square box back into itself under the same fixed lamps: pictures from
// four sides are the same. Under a light that stays with the box they are not.
TEST(Picture, OnATurntableASquareBoxLooksTheSameFromItsFourSides) {
  const SgMixture lamps = light_by_name("daylight");
  SyntheticScene scene = scene_of(box_shape(), {{0.4f, 0.5f, 0}, {0.5f, 0.3f, 0.2f}}, lamps);
  const Camera first = look_at({3, 1, 1.5}, {0, 0, 0}, lens_of_size(24, 24));
  scene.light = turned_with(lamps, first.center);
  const Image truth = draw(scene, first, {.samples = 512}).color;
  Vec3d eye = first.center;
  for (int side = 1; side < 4; ++side) {
    eye = {-eye.y, eye.x, eye.z};
    const Camera camera = look_at(eye, {0, 0, 0}, lens_of_size(24, 24));
    scene.light = turned_with(lamps, camera.center);
    const double turned = mean_difference(draw(scene, camera, {.samples = 512}).color, truth);
    scene.light = turned_with(lamps, first.center);
    const double still = mean_difference(draw(scene, camera, {.samples = 512}).color, truth);
    EXPECT_LT(turned, 1.2e-3) << side;  // what is left is noise
    EXPECT_GT(still, 2.5e-3) << side;
  }
}

TEST(Picture, WithoutLightHasTheColorsAsked) {
  const Camera camera = look_at({0, -3, 1}, {0, 0, 0}, lens_of_size(20, 20));
  const Image image = draw_unlit(*ball_shape().body, camera, [](Vec3f p) { return p; });
  int seen = 0;
  for (int y = 0; y < 20; ++y)
    for (int x = 0; x < 20; ++x) {
      if (image.at(x, y)[3] == 0) continue;
      ++seen;
      const Vec3d back = camera.project(to_double(image.rgb(x, y)));
      EXPECT_NEAR(back.x, x + 0.5, 1e-3);
      EXPECT_NEAR(back.y, y + 0.5, 1e-3);
      EXPECT_NEAR(length(image.rgb(x, y)), BallDistance{}.radius, 2e-4);
    }
  EXPECT_GT(seen, 150);
}

}  // namespace
}  // namespace cei3d
