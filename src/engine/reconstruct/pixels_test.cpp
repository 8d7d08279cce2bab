// SPDX-License-Identifier: Apache-2.0
#include "engine/reconstruct/pixels.h"

#include <gtest/gtest.h>

#include "core/math/color.h"

namespace cei3d {
namespace {

// Two views of 2 x 1 pixels: gray of .2 and clipped white, the second one at half the exposure.
PixelStore two_views() {
  PixelStore store;
  Camera camera;
  camera.width = 2, camera.height = 1;
  for (const float bright : {1.0f, 0.5f}) {
    Image image(2, 1, 4, 1);
    for (size_t c = 0; c < 3; ++c) image.data[c] = 0.2f * bright;
    image.data[3] = 0.6f;
    store.add_view(camera, image, 0);
  }
  return store;
}

TEST(PixelStore, DividesColorsByExposures) {
  PixelStore store = two_views();
  const Target before = store.target(store.pixels()[0]);
  store.set_exposures({{1, 1, 1}, {0.5f, 0.5f, 0.5f}});
  constexpr float kByte = 0.004f;
  for (int c = 0; c < 3; ++c) {
    EXPECT_NEAR(store.radiance(2)[c], 0.2f, kByte);
    EXPECT_NEAR(store.radiance(3)[c], 2, kByte);
    EXPECT_NEAR(store.target(store.pixels()[2]).srgb[c], before.srgb[c], kByte);
    EXPECT_EQ(store.target(store.pixels()[3]).srgb[c], 1);  // no brighter than white
  }
  EXPECT_EQ(store.target(store.pixels()[2]).alpha, before.alpha);
}

TEST(PixelStore, ClipsByTheFileWhateverTheExposure) {
  PixelStore store = two_views();
  store.set_exposures({{2, 2, 2}, {0.4f, 0.4f, 0.4f}});
  EXPECT_EQ(store.clipped(0), 0);
  EXPECT_EQ(store.clipped(1), 7);
  EXPECT_EQ(store.clipped(2), 0);
  EXPECT_EQ(store.clipped(3), 7);
}

TEST(PixelStore, WithoutExposuresHasTheColorsOfTheFile) {
  PixelStore store = two_views();
  const Pixel p = store.pixels()[0];
  const float a = float(p.srgba[3]) / 255;
  EXPECT_EQ(store.target(p).srgb.x, float(p.srgba[0]) / 255 * a + (1 - a));
  EXPECT_EQ(store.radiance(0).x, linear_from_srgb(float(p.srgba[0]) / 255));
}

}  // namespace
}  // namespace cei3d
