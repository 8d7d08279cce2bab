// SPDX-License-Identifier: Apache-2.0
#include "engine/reconstruct/live_picture.h"

#include <gtest/gtest.h>

#include "core/math/color.h"
#include "engine/render/render.h"
#include "engine/render/sphere_scene.h"

namespace cei3d {
namespace {

Camera camera_of(int width, int height) {
  Camera c;
  c.width = width, c.height = height;
  c.fx = c.fy = width;
  c.cx = 0.5 * width, c.cy = 0.5 * height;
  return c;
}

TEST(LivePicture, TakesAHundredthOfTheTimeAndIsSmall) {
  double now = 0, drawing = 0;
  int shown = 0;
  LivePicture live(
      camera_of(800, 600), [&](const Image&) { ++shown; }, [&] { return now; });
  for (; now < 1000; now += 0.1)
    live.offer([&](const Camera& c) {
      EXPECT_LE(std::max(c.width, c.height), 160);
      EXPECT_GE(std::max(c.width, c.height), 80);
      now += 0.2, drawing += 0.2;
      return Image(c.width, c.height, 3);
    });
  EXPECT_GT(shown, 40);
  EXPECT_LT(drawing / now, 0.0105);
}

TEST(LivePicture, OfWhatIsDrawnAtOnceComesEveryThreeSeconds) {
  double now = 0;
  int shown = 0;
  LivePicture live(
      camera_of(100, 100), [&](const Image&) { ++shown; }, [&] { return now; });
  for (; now < 30; now += 0.5) live.offer([](const Camera& c) { return Image(c.width, c.height, 3); });
  EXPECT_EQ(shown, 10);
}

TEST(LivePicture, IsNotDrawnWithoutAnObserver) {
  LivePicture live(camera_of(100, 100), {}, [] {
    ADD_FAILURE() << "without an observer the time is not needed";
    return 0.0;
  });
  live.offer([](const Camera&) {
    ADD_FAILURE() << "there is no observer";
    return Image();
  });
}

TEST(LitPicture, IsTheFrameOfTheObject) {
  const Device device = make_device();
  const Scene scene = sphere_scene();
  const Camera camera = camera_towards_origin({2.4, 0.3, 0.5}, 48);
  const Lighting lighting(device, scene.surface, scene.light,
                          scene.albedo->eval3(device, scene.surface->mesh().positions),
                          scene.material.mean());
  const Image got = lit_picture(
      device, {*scene.sdf, scene.surface, lighting, *scene.albedo, scene.material, nullptr}, camera);
  const Image frame = shade_view(device, scene, trace_view(device, scene, camera, 2)).rgb;
  int object = 0;
  for (int y = 0; y < camera.height; ++y)
    for (int x = 0; x < camera.width; ++x) {
      const float* p = frame.at(x, y);
      object += p[3] == 1;
      for (int c = 0; c < 3; ++c)
        EXPECT_NEAR(got.at(x, y)[c], srgb_from_linear(p[c]) * p[3] + 1 - p[3], 1e-5f) << x << ' ' << y;
    }
  EXPECT_GT(object, 300);
}

}  // namespace
}  // namespace cei3d
