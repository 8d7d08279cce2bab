// SPDX-License-Identifier: Apache-2.0
// A capture in PhySG's layout with linear EXR images, and the same as 8-bit PNG: training sees the highlights
// of the one, and lower bounds of those of the other.
#include <gtest/gtest.h>

#include <cmath>

#include "core/base/temp_folder.h"
#include "core/math/color.h"
#include "engine/capture/capture.h"
#include "engine/capture/capture_images.h"
#include "engine/capture/normalize.h"
#include "engine/reconstruct/training_views.h"
#include "engine/synthetic/synthetic_capture.h"

namespace cei3d {
namespace {

constexpr int kSize = 40;

class LinearCapture : public ::testing::Test {
 protected:
  std::filesystem::path write(SynthLayout layout) {
    SynthRequest r;
    r.out = temp_.path() / (layout == SynthLayout::physg ? "physg" : "nerf");
    r.shape = "ball";
    r.material = "gloss";
    r.light_strength = 2;
    r.layout = layout;
    r.width = r.height = kSize;
    r.views = 4, r.test_views = 1;
    r.samples = 16;
    Progress quiet;
    make_capture(r, quiet);
    return r.out;
  }
  TrainingViews training(const Capture& capture) {
    Progress quiet;
    return load_training_views(capture, CaptureImages(), find_normalization(capture), quiet);
  }
  TempFolder temp_;
};

TEST_F(LinearCapture, KeepsRadianceAboveOne) {
  const Capture exr = load_capture(write(SynthLayout::physg)), png = load_capture(write(SynthLayout::nerf));
  EXPECT_EQ(exr.format, "physg");
  EXPECT_TRUE(exr.warnings.empty());
  ASSERT_EQ(exr.views.size(), png.views.size());
  for (size_t i = 0; i < exr.views.size(); ++i) {
    const Camera &a = exr.views[i].camera, &b = png.views[i].camera;
    EXPECT_EQ(exr.views[i].name, png.views[i].name);
    EXPECT_LT(length(a.center - b.center), 1e-9);
    EXPECT_NEAR(a.cx, b.cx, 1e-9);
    EXPECT_NEAR(a.fx, b.fx, 1e-9);
    for (int r = 0; r < 3; ++r) EXPECT_LT(length(a.world_from_cam.row[r] - b.world_from_cam.row[r]), 1e-9);
  }
  const PixelStore linear = training(exr).train, bytes = training(png).train;
  ASSERT_EQ(linear.pixels().size(), bytes.pixels().size());
  std::vector<Image> files;
  for (const View& v : views_of(exr, Split::train)) files.push_back(load_linear_rgba(v));
  size_t above = 0;
  for (size_t i = 0; i < linear.pixels().size(); ++i) {
    const Pixel& p = linear.pixels()[i];
    if (p.srgba[3] < 255) continue;
    const float* stored = files[p.view].at(p.x, p.y);
    for (int c = 0; c < 3; ++c) {
      const float truth = stored[c], got = linear.radiance(i)[c], clamped = bytes.radiance(i)[c];
      EXPECT_NEAR(got, truth, truth * 0x1p-11f + 1e-7f);
      EXPECT_NEAR(srgb_from_linear(clamped), std::min(srgb_from_linear(truth), 1.0f), 0.6f / 255);
      EXPECT_EQ(linear.clipped(i), 0);
      EXPECT_EQ(bytes.clipped(i) >> c & 1, srgb_from_linear(truth) >= 254.5f / 255);
      above += truth > 1.2f;
    }
  }
  EXPECT_GT(above, 10u);
}

// Sixteen bits end at 1, in finer steps.
TEST_F(LinearCapture, SixteenBitsAreLowerBoundsAtOne) {
  Image image(8, 8, 4, 1);
  for (int x = 0; x < 8; ++x)
    for (int c = 0; c < 3; ++c) image.at(x, 3)[c] = 0.2f + 0.1001f * float(x);
  Camera camera;
  camera.width = camera.height = 8;
  PixelStore store;
  store.add_view(camera, image, 0, ImageDepth::bits8);
  store.add_view(camera, image, 0, ImageDepth::bits16);
  store.add_view(camera, image, 0, ImageDepth::bits8);
  for (int x = 0; x < 8; ++x) {
    const float truth = 0.2f + 0.1001f * float(x);
    const size_t first = size_t(3 * 8 + x), deep = first + 64, last = deep + 64;
    EXPECT_EQ(store.radiance(first).x, store.radiance(last).x);
    EXPECT_NEAR(store.radiance(deep).x, truth, truth * 0x1p-11f);
    EXPECT_NEAR(store.radiance(first).x, truth, 0.006);
    EXPECT_EQ(store.clipped(deep), 0);
  }
  EXPECT_EQ(store.clipped(64), 7);
  EXPECT_EQ(store.clipped(0), 7);
}

}  // namespace
}  // namespace cei3d
