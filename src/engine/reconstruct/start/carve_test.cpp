// SPDX-License-Identifier: Apache-2.0
#include "engine/reconstruct/start/carve.h"

#include <gtest/gtest.h>

#include "engine/reconstruct/test_box.h"

namespace cei3d {
namespace {

Vec3f checkered(Vec3f p) {
  const bool dark = (int(std::floor(p.x * 8)) + int(std::floor(p.y * 8)) + int(std::floor(p.z * 8))) & 1;
  return dark ? Vec3f{0.1f, 0.1f, 0.3f} : Vec3f{0.8f, 0.6f, 0.2f};
}

TEST(Carve, OpensAPitThatNoSilhouetteShows) {
  PixelStore pixels;
  for (int i = 0; i < 40; ++i) {
    const Camera c = box_camera(0.95 - 1.1 * i / 40, 2.39996 * i, 48);
    pixels.add_view(c, box_picture(c, checkered), 6);
  }
  const VisualHull hull = hull_of(pixels, 40);
  CarveOptions options;
  options.steps = 400;
  options.rays = 2048;
  const VisualHull carved = carve(pixels, hull, options);
  for (size_t i = 0; i < hull.inside.size(); ++i) EXPECT_LE(carved.inside[i], hull.inside[i]);
  const Opened opened = opened_of(hull, carved);
  EXPECT_GT(opened.cells, 300);  // the hull has it filled
  EXPECT_GT(opened.pit, 0.8);
  EXPECT_LT(opened.solid, 0.15);
  EXPECT_EQ(carve(pixels, hull, options).inside, carved.inside);
}

}  // namespace
}  // namespace cei3d
