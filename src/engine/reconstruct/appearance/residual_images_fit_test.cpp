// SPDX-License-Identifier: Apache-2.0
// A sphere whose photographs show what its light and material do not know of.
#include "engine/reconstruct/appearance/residual_images_fit.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>

#include "core/math/rng.h"
#include "engine/render/render.h"
#include "engine/render/scene_light.h"
#include "engine/render/sphere_scene.h"
#include "model/scene/appearance.h"

namespace cei3d {
namespace {

constexpr int kViews = 10, kSize = 64;

using Unknown = std::function<Vec3f(const Hit&, int view)>;  // radiance

// On a circle of every 12 degrees.
Camera camera_of(double view) {
  const double turn = view * 0.21;
  return camera_towards_origin({3 * std::cos(turn), 3 * std::sin(turn), 0.8}, kSize);
}

std::vector<Vec3f> radiance_of(const Device& device, const Scene& scene, const std::vector<Hit>& hits) {
  const Shading s =
      SceneLight(device, scene, scene_transports(scene)).shade(hits, appearance_at(device, scene, hits));
  std::vector<Vec3f> out;
  for (size_t i = 0; i < hits.size(); ++i) out.push_back(s.diffuse[i] + s.specular[i]);
  return out;
}

PixelStore photographs(const Device& device, const Scene& scene, const Unknown& unknown) {
  PixelStore store;
  for (int v = 0; v < kViews; ++v) {
    Image image(kSize, kSize, 4);
    std::vector<Ray> rays;
    for (int i = 0; i < kSize * kSize; ++i)
      rays.push_back(camera_of(v).ray(i % kSize + 0.5, i / kSize + 0.5));
    std::vector<uint32_t> ray_of_hit;
    const std::vector<Hit> hits = trace_rays(device, *scene.sdf, *scene.surface, rays, ray_of_hit);
    const std::vector<Vec3f> radiance = radiance_of(device, scene, hits);
    for (size_t i = 0; i < hits.size(); ++i) {
      float* p = &image.data[4 * ray_of_hit[i]];
      for (int c = 0; c < 3; ++c) p[c] = radiance[i][c] + unknown(hits[i], v)[c];
      p[3] = 1;
    }
    store.add_view(camera_of(v), image, 0, ImageDepth::open);
  }
  return store;
}

ResidualImagesFit fit(const Device& device, const Scene& scene, const Unknown& unknown,
                      const ResidualImagesOptions& options = {}) {
  Progress quiet;
  return fit_residual_images(device, scene, photographs(device, scene, unknown), nullptr, options, quiet);
}

// Stripes of the surface, under light that comes mostly from one side.
Vec3f stripes(const Hit& h, int) {
  const float s = std::sin(12 * h.position.z) * (0.6f + 0.4f * h.to_camera.x);
  return Vec3f{0.1f, 0.08f, 0.05f} * (1 + s);
}

double error_between_views(const Device& device, const Scene& scene, const ResidualImages& images) {
  const std::vector<Hit> hits = trace_view(device, scene, camera_of(4.5), 1).hits;
  double error = 0, all = 0;
  for (const Hit& h : hits) {
    if (dot(h.normal, h.to_camera) < 0.3f) continue;
    const Vec3f d = images.at(h) - stripes(h, 0);
    error += dot(d, d), all += dot(stripes(h, 0), stripes(h, 0));
  }
  return std::sqrt(error / all);
}

TEST(ResidualImagesFit, CorrectsAViewThatWasNotPhotographed) {
  const Device device = make_device("cpu");
  const Scene scene = sphere_scene();
  const ResidualImagesFit got = fit(device, scene, stripes);
  ASSERT_TRUE(got.images);
  EXPECT_LT(error_between_views(device, scene, *got.images), 0.1);
  EXPECT_GT(got.explained.with_residual, got.explained.physical + 10);
}

// Of the sphere there are about 1600 pixels in each photograph, so that four become one.
TEST(ResidualImagesFit, ReducesPhotographsThatHaveTooManyPixels) {
  const Device device = make_device("cpu");
  const Scene scene = sphere_scene();
  ResidualImagesOptions options;
  options.max_pixels = 5000;
  const ResidualImagesFit got = fit(device, scene, stripes, options);
  ASSERT_TRUE(got.images);
  EXPECT_LE(got.images->images()[0].camera().width, kSize / 2);
  EXPECT_LT(error_between_views(device, scene, *got.images), 0.2);
}

// Between two looks at the clock passes a second, until the first photograph is done; then `later`.
ResidualImagesFit fit_in(double seconds, double later = 1) {
  ResidualImagesOptions options;
  options.seconds = seconds;
  options.clock = [looks = 0, later]() mutable {
    const int n = looks++;
    return std::min(n, 3) + later * std::max(n - 3, 0);
  };
  return fit(make_device("cpu"), sphere_scene(), stripes, options);
}

// By the first, ten photographs take ten seconds.
TEST(ResidualImagesFit, LeavesPhotographsOutBeforeItReducesThem) {
  const ResidualImagesFit all = fit_in(1000), some = fit_in(8), few = fit_in(4, 0.1);
  ASSERT_TRUE(all.images && some.images && few.images);
  EXPECT_EQ(all.images->images().size(), size_t(kViews));
  EXPECT_GT(all.images->images()[0].camera().width, kSize / 2);
  EXPECT_GT(some.images->images()[0].camera().width, kSize / 2);  // there is time for half of them
  EXPECT_LT(some.images->images().size(), size_t(kViews));
  EXPECT_GT(some.images->images().size(), size_t(kViews) / 2 - 2);
  EXPECT_LE(few.images->images()[0].camera().width, kSize / 2);
}

TEST(ResidualImagesFit, NoiseIsNoCorrection) {
  const Device device = make_device("cpu");
  const ResidualImagesFit got = fit(device, sphere_scene(), [](const Hit& h, int view) {
    Rng rng(uint64_t(view), uint64_t(1e6f * (h.position.x + 2)), uint64_t(1e6f * (h.position.z + 2)));
    return Vec3f{0.02f * rng.normal(), 0.02f * rng.normal(), 0.02f * rng.normal()};
  });
  EXPECT_FALSE(got.images);
}

}  // namespace
}  // namespace cei3d
