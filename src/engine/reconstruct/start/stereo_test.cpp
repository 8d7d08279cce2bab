// SPDX-License-Identifier: Apache-2.0
#include "engine/reconstruct/start/stereo.h"

#include <gtest/gtest.h>

#include "core/base/parallel.h"
#include "core/math/rng.h"
#include "engine/reconstruct/test_box.h"

namespace cei3d {
namespace {

// The same from afar, everywhere; speckles tell one place from another.
Vec3f speckled(Vec3f p) {
  constexpr float kSpeckles = 30;  // a unit
  const auto cell = [&](float v) { return uint64_t(int64_t(std::floor(v * kSpeckles)) + 1000); };
  const float gray = 0.3f + 0.2f * Rng(cell(p.x), cell(p.y), cell(p.z)).uniform();
  return {gray, gray, gray};
}

struct Box : testing::Test {
  static void SetUpTestSuite() {
    for (int i = 0; i < 48; ++i) {
      const Camera c = box_camera(0.95 - 1.1 * i / 48, 2.39996 * i, 112);
      pixels.add_view(c, box_picture(c, speckled), 6);
    }
    hull = hull_of(pixels, 40);
    maps = stereo_depths(pixels, hull, {});
  }
  static inline PixelStore pixels;
  static inline VisualHull hull;
  static inline std::vector<DepthMap> maps;
};

TEST_F(Box, DepthsAreThoseOfTheSurface) {
  int on_object = 0, known = 0, right = 0;
  for (const DepthMap& map : maps)
    for (int y = 0; y < map.camera.height; ++y)
      for (int x = 0; x < map.camera.width; ++x) {
        const Ray ray = map.camera.ray(x + 0.5, y + 0.5);
        const float distance = pit_box().cast(ray), depth = map.depth[size_t(y) * map.camera.width + x];
        on_object += distance > 0;
        known += depth > 0;
        right += distance > 0 && depth > 0 &&
                 std::abs(depth - distance * dot(ray.direction, map.camera.forward())) < 0.04f;
      }
  EXPECT_GT(known, 0.5 * on_object);
  EXPECT_GT(right, 0.9 * known);
}

TEST_F(Box, APitThatNoSilhouetteShowsIsOpened) {
  const VisualHull carved = carve_by_depths(hull, maps);
  const Opened opened = opened_of(hull, carved);
  EXPECT_GT(opened.pit, 0.8);
  EXPECT_LT(opened.solid, 0.05);
}

TEST_F(Box, SameBitsOnOneThread) {
  const std::vector<DepthMap> again = Threads(1).run([&] { return stereo_depths(pixels, hull, {}); });
  for (size_t v = 0; v < maps.size(); ++v) EXPECT_EQ(again[v].depth, maps[v].depth);
}

// A smooth gray object tells nothing: better no depth than a wrong one.
TEST(Stereo, WithoutTextureNothingIsKnown) {
  PixelStore pixels;
  for (int i = 0; i < 12; ++i) {
    const Camera c = box_camera(0.6, 0.25 * i, 64);
    pixels.add_view(c, box_picture(c, [](Vec3f) { return Vec3f{0.5f, 0.5f, 0.5f}; }), 6);
  }
  const VisualHull hull = hull_of(pixels, 40);
  const std::vector<DepthMap> maps = stereo_depths(pixels, hull, {});
  for (const DepthMap& map : maps)
    for (const float depth : map.depth) EXPECT_EQ(depth, 0);
  EXPECT_EQ(carve_by_depths(hull, maps).inside, hull.inside);
}

}  // namespace
}  // namespace cei3d
