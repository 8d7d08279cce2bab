// SPDX-License-Identifier: Apache-2.0
#include "engine/reconstruct/start.h"

#include <gtest/gtest.h>

#include "engine/reconstruct/test_box.h"

namespace cei3d {
namespace {

// A ball with an upright rod beside it, thinner than a cell and as far from cell centres as can be.
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

PixelStore photographs() {
  PixelStore store;
  for (int v = 0; v < 24; ++v) {
    const Camera camera = box_camera(-0.5 + v / 23.0, 2.4 * v, 400);
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

}  // namespace
}  // namespace cei3d
