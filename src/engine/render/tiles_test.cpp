// SPDX-License-Identifier: Apache-2.0
#include "engine/render/tiles.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstring>

#include "engine/render/sphere_scene.h"

namespace cei3d {
namespace {

TEST(Tiles, CoverEveryPixelOnceAndBeginInTheMiddle) {
  const std::vector<PixelBox> tiles = tiles_of(150, 97, 64);
  std::vector<int> count(150 * 97, 0);
  for (const PixelBox& t : tiles)
    for (int y = t.y0; y < t.y0 + t.height; ++y)
      for (int x = t.x0; x < t.x0 + t.width; ++x) ++count[size_t(y) * 150 + x];
  EXPECT_EQ(std::count(count.begin(), count.end(), 1), 150 * 97);
  EXPECT_EQ(tiles.front(), (PixelBox{64, 0, 64, 64}));
  EXPECT_EQ(tiles.back(), (PixelBox{128, 64, 22, 33}));
}

bool same_bits(const Image& a, const Image& b) {
  return a.data.size() == b.data.size() &&
         std::memcmp(a.data.data(), b.data.data(), a.data.size() * sizeof(float)) == 0;
}

// Also at a camera whose numbers are not round, and where silhouettes cross the borders of tiles.
TEST(Tiles, AreTheWholeFrameBitForBit) {
  const Device device = make_device();
  const Scene scene = sphere_scene();
  Camera camera = camera_towards_origin({0.31, -2.9, 0.47}, 90);
  camera.cx += 0.123456789;
  camera.cy -= 7.31;
  camera.height = 70;
  for (const int samples : {1, 2}) {
    RenderCache frames(device);
    const SceneLight light = frames.light(scene);
    const Frame whole = frames.shade(scene, light, *frames.trace(scene, camera, samples));
    for (const PixelBox& box : tiles_of(camera.width, camera.height, 32)) {
      const Frame tile = render_tile(frames, scene, light, camera, samples, box), want = cropped(whole, box);
      for (const auto image : {&Frame::rgb, &Frame::albedo, &Frame::diffuse, &Frame::specular, &Frame::normal,
                               &Frame::depth, &Frame::roughness, &Frame::metalness, &Frame::mask})
        EXPECT_TRUE(same_bits(tile.*image, want.*image)) << samples << ' ' << box.x0 << ' ' << box.y0;
      EXPECT_EQ(tile.edited, want.edited);
    }
  }
}

}  // namespace
}  // namespace cei3d
