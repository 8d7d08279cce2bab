// SPDX-License-Identifier: Apache-2.0
#include "engine/segment/sam.h"

#include <gtest/gtest.h>

#include <cmath>

#include "core/base/test_source.h"
#include "core/image/resample.h"

namespace cei3d {
namespace {

// `./run sam` fills it.
const std::filesystem::path kFolder = source_file("build/sam");

// A disc of one color on a square of another, on nothing.
Image disc(float cx, float cy, float radius) {
  Image image(200, 160, 4);
  for (int y = 20; y < 140; ++y) {
    for (int x = 40; x < 160; ++x) {
      const bool in = std::hypot(float(x) + 0.5f - cx, float(y) + 0.5f - cy) < radius;
      float* p = image.at(x, y);
      p[0] = in ? 0.8f : 0.1f;
      p[1] = in ? 0.2f : 0.2f;
      p[2] = in ? 0.1f : 0.6f;
      p[3] = 1;
    }
  }
  return image;
}

TEST(SamFrame, ShowsTheObjectEnlarged) {
  const SamFrame f = sam_frame(disc(100, 80, 30));
  // 120 pixels and a margin of a twelfth or so: 140.
  EXPECT_EQ(f.x0, 30);
  EXPECT_EQ(f.y0, 10);
  EXPECT_NEAR(f.scale, 1024.0 / 140, 1e-4);
  EXPECT_EQ(f.rgb.width, 1024);
  EXPECT_EQ(f.rgb.height, 1024);
  const Vec3f middle = f.rgb.rgb(512, 512);  // of the disc: 0.8 linear is 0.906 sRGB
  EXPECT_NEAR(middle.x, 255 * 0.9063f, 0.1);
  EXPECT_NEAR(f.rgb.rgb(5, 5).x, 127.5, 0.1);  // beside the object
}

TEST(SamFrame, WithoutAnObjectShowsAll) {
  const SamFrame f = sam_frame(Image(300, 150, 4));
  EXPECT_EQ(f.x0, 0);
  EXPECT_EQ(f.rgb.width, 1024);
  EXPECT_EQ(f.rgb.height, 512);
}

bool installed() {
  return std::filesystem::exists(kFolder / "encoder.onnx") && OnnxRuntime::available(kFolder);
}
constexpr const char* kNotInstalled = "no segmentation network here; ./run sam installs it";

// Intersection over union of the mask that the network finds of disc(110, 70, 30), and the disc.
float agreement(const Sam& sam, const SamImage& image) {
  const Vec2f in[2] = {{110, 70}, {122, 78}}, out[1] = {{60, 120}};
  const Image mask = sam.mask(image, in, out);
  if (mask.width != 200 || mask.height != 160) return 0;
  int both = 0, either = 0;
  for (int y = 0; y < 160; ++y) {
    for (int x = 0; x < 200; ++x) {
      const bool truth = std::hypot(float(x) + 0.5f - 110, float(y) + 0.5f - 70) < 30;
      const bool found = *mask.at(x, y) > 0;
      both += truth && found;
      either += truth || found;
    }
  }
  return float(both) / float(either);
}

TEST(Sam, FindsADisc) {
  if (!installed()) GTEST_SKIP() << kNotInstalled;
  const Sam sam(kFolder);
  EXPECT_GT(agreement(sam, sam.encode(disc(110, 70, 30))), 0.95);
}

TEST(Sam, FindsADiscOfAnImageOfWhichASectionWasEncoded) {
  if (!installed()) GTEST_SKIP() << kNotInstalled;
  const Sam sam(kFolder);
  const PixelBox box{30, 12, 140, 136};
  const Image section = scaled_to(cropped(disc(110, 70, 30), box), 280, 272);
  EXPECT_GT(agreement(sam, of_whole(sam.encode(section), 200, 160, box, 2)), 0.95);
}

}  // namespace
}  // namespace cei3d
