// SPDX-License-Identifier: Apache-2.0
#include "engine/reconstruct/start/start.h"

#include <gtest/gtest.h>

#include "engine/reconstruct/test_box.h"

namespace cei3d {
namespace {

// A ball with an upright rod beside it, thinner than a cell and as far from cell centers as can be.
constexpr float kRodRadius = 0.006f, kRodX = 0.625f, kRodHeight = 0.4f;

bool on_object(const Ray& ray) {
  const float along = -dot(ray.origin, ray.direction);
  if (length(ray.origin + ray.direction * along) < 0.3f) return true;
  // Nearest approach to the rod's axis, seen from above, and how high that is.
  const Vec3f from = ray.origin - Vec3f{kRodX, 0, 0};
  const float flat = square(ray.direction.x) + square(ray.direction.y);
  const float t = -(from.x * ray.direction.x + from.y * ray.direction.y) / flat;
  const Vec3f p = from + ray.direction * t;
  return std::abs(p.z) < kRodHeight && std::hypot(p.x, p.y) < kRodRadius;
}

// 24 views; all but the first `wide` do not have the rod in their frames.
PixelStore photographs(int wide = 24) {
  PixelStore store;
  for (int v = 0; v < 24; ++v) {
    const bool narrow = v >= wide;
    // Those do not look along the line from ball to rod.
    Camera camera = box_camera(-0.5 + v / 23.0, narrow ? 1.2 + 0.03 * v : 2.4 * v, 400);
    if (narrow) camera.width = 200, camera.cx = 100;
    Image image(camera.width, camera.height, 4);
    for (int y = 0; y < camera.height; ++y)
      for (int x = 0; x < camera.width; ++x)
        if (on_object(camera.ray(x + 0.5, y + 0.5))) std::fill_n(image.at(x, y), 4, 1.0f);
    store.add_view(camera, image, 2);
  }
  return store;
}

TEST(Start, HullKeepsARodThinnerThanItsCells) {
  const StartShape start = start_shape(photographs(), Start::hull, 1);
  ASSERT_LT(2 * kRodRadius, 2.0f / float(start.distance.n));
  for (float z = -0.38f; z < 0.38f; z += 0.01f) EXPECT_LT(start.distance.at({kRodX, 0, z}), 0) << z;
  EXPECT_GT(start.distance.at({kRodX + 0.04f, 0, 0}), 0);
  EXPECT_GT(start.distance.at({0.46f, 0, 0}), 0.1f);
}

TEST(Start, NoMatterWhereTooFewViewsLook) {
  const Vec3f rod{kRodX, 0, 0}, ball{0, 0, 0};
  const StartShape two = start_shape(photographs(2), Start::hull, 1),
                   three = start_shape(photographs(3), Start::hull, 1);
  EXPECT_GT(two.distance.at(rod), 0);
  EXPECT_LT(two.distance.at(ball), -0.2f);
  EXPECT_LT(three.distance.at(rod), 0);
  EXPECT_LT(three.distance.at(ball), -0.2f);
}

TEST(PixelStore, UnknownPixelsAreNeitherObjectNorBackground) {
  Image image(5, 1, 4);
  image.at(1, 0)[3] = 1;
  image.at(2, 0)[3] = -1;
  Camera camera;
  camera.width = 5, camera.height = 1;
  PixelStore store;
  store.add_view(camera, image, 2);
  std::vector<int> columns;
  for (const Pixel& p : store.pixels()) columns.push_back(p.x);
  EXPECT_EQ(columns, (std::vector<int>{0, 1, 3}));
  EXPECT_EQ(store.masks()[0],
            (std::vector<uint8_t>{kBackground, kObject, kUnknown, kBackground, kBackground}));
}

}  // namespace
}  // namespace cei3d
