// SPDX-License-Identifier: Apache-2.0
// Paint in display color on an object whose color is a network over position and direction, in the dark.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstring>

#include "core/math/color.h"
#include "engine/edit/paint.h"
#include "engine/render/random_residual.h"
#include "engine/render/render.h"
#include "engine/render/sphere_scene.h"

namespace cei3d {
namespace {

constexpr int kSize = 96;
const Vec3f kOrange{0.8f, 0.4f, 0.2f};  // sRGB, in steps of 1/255

Image square_of(Vec3f color) {
  Image s(kSize, kSize, 4);
  for (int y = 40; y < 56; ++y)
    for (int x = 40; x < 56; ++x) {
      for (int c = 0; c < 3; ++c) s.at(x, y)[c] = color[c];
      s.at(x, y)[3] = 1;
    }
  return s;
}

TEST(CoupledPaint, IsShownAsItIsAndTheRestStays) {
  const Device device = make_device();
  Scene scene = sphere_scene();
  scene.light.lobes = {{{0, 0, 1}, 1, {0, 0, 0}}};
  scene.residual = random_residual(*scene.albedo, 0.2f);
  const Camera front = camera_towards_origin({0, -3, 0.3}, kSize);
  PaintRequest request{{{front, square_of(kOrange)}}, "0001-paint"};
  request.unlit = true;
  Progress quiet;
  const Scene after = with_layer(scene, paint(device, scene, request, quiet).layer);
  const GBuffer g = trace_view(device, scene, front, 1);
  const Frame a = shade_view(device, scene, g), b = shade_view(device, after, g);
  const Vec3f wanted = linear_from_srgb(kOrange);
  float brightest = 0;
  for (int y = 0; y < kSize; ++y)
    for (int x = 0; x < kSize; ++x) {
      const size_t p = size_t(y) * kSize + x;
      for (int c = 0; c < 3; ++c) brightest = std::max(brightest, a.rgb.at(x, y)[c]);
      if (!b.edited[p]) {
        EXPECT_EQ(std::memcmp(a.rgb.at(x, y), b.rgb.at(x, y), 16), 0);
      }
      if (x < 43 || x >= 53 || y < 43 || y >= 53) continue;
      for (int c = 0; c < 3; ++c) EXPECT_NEAR(b.rgb.at(x, y)[c], wanted[c], 1e-3f) << x << " " << y;
    }
  EXPECT_GT(brightest, 0.01f);
}

}  // namespace
}  // namespace cei3d
