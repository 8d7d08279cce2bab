// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include "core/math/sub_pixel.h"
#include "engine/render/render.h"
#include "engine/render/sphere_scene.h"

namespace cei3d {
namespace {

bool meets_sphere(const Ray& ray) {
  const float along = -dot(ray.origin, ray.direction);
  return length(ray.origin + ray.direction * along) < kSphereRadius;
}

// Share of the sphere in what a pixel's tent covers, by many rays.
float coverage(const Camera& camera, int x, int y) {
  constexpr int kDense = 24;
  float sum = 0, all = 0;
  for (int dy = -1; dy <= 1; ++dy)
    for (int dx = -1; dx <= 1; ++dx)
      for (int k = 0; k < kDense * kDense; ++k) {
        const Vec2f p = sub_pixel(k, kDense);
        const float w = tent_weight({float(dx) + p.x - 0.5f, float(dy) + p.y - 0.5f});
        all += w;
        if (w > 0 && meets_sphere(camera.ray(x + dx + double(p.x), y + dy + double(p.y)))) sum += w;
      }
  return sum / all;
}

TEST(TraceView, SilhouettesAreSmooth) {
  const Device device = make_device();
  const Scene scene = sphere_scene();
  const Camera camera = camera_towards_origin({0.3, -3, 0.4}, 48);
  const GBuffer g = trace_view(device, scene, camera, 2);
  const Frame frame = shade_view(device, scene, g);
  double squared = 0;
  int rim = 0;
  for (int y = 1; y < 47; ++y)
    for (int x = 1; x < 47; ++x) {
      const float want = coverage(camera, x, y), got = frame.mask.data[size_t(y) * 48 + x];
      if (want == 0 || want == 1) {
        EXPECT_EQ(got, want) << x << ' ' << y;
        continue;
      }
      squared += square(double(got - want));
      ++rim;
    }
  ASSERT_GT(rim, 100);
  // Four samples per pixel all over would leave .05.
  EXPECT_LT(std::sqrt(squared / rim), 0.015);
}

TEST(TraceView, OnlyTheSilhouetteHasMoreSamplesThanAskedFor) {
  const Camera camera = camera_towards_origin({0.3, -3, 0.4}, 48);
  const GBuffer one = trace_view(make_device(), sphere_scene(), camera, 1),
                nine = trace_view(make_device(), sphere_scene(), camera, 3);
  int finer = 0;
  for (size_t p = 0; p < nine.samples.size(); ++p) {
    EXPECT_EQ(one.samples[p], 1);
    const float covered = coverage(camera, int(p % 48), int(p / 48));
    if (covered > 0.1f && covered < 0.9f) {
      EXPECT_EQ(nine.samples[p], 6) << p;
    }
    finer += nine.samples[p] != 3;
  }
  EXPECT_LT(finer, 0.2 * 48 * 48);
}

}  // namespace
}  // namespace cei3d
