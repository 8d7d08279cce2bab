// SPDX-License-Identifier: Apache-2.0
// The field of a ball against pictures of a ball of another size.
#include "engine/reconstruct/geometry/silhouette_level.h"

#include <gtest/gtest.h>

#include <cmath>

namespace cei3d {
namespace {

constexpr float kRadius = 0.5f;

// |x| - kRadius: a network without weights.
Field ball_field() {
  FieldConfig c;
  c.encoding.frequencies = 2;
  c.width = 32;
  c.outputs = 1;
  c.sphere_radius = kRadius;
  Field field(c, 1);
  for (Param& p : field.params().all()) std::fill(p.value.begin(), p.value.end(), 0.0f);
  return field;
}

// Cameras around a ball; `soft`: with the coverage of the tent filter, else black and white.
PixelStore pictures(float radius, bool soft) {
  PixelStore store;
  for (int k = 0; k < 8; ++k) {
    const double a = 2 * M_PI * k / 8;
    const Vec3d center{2.5 * std::cos(a), 2.5 * std::sin(a), 0.4},
        z = -center / length(center), x = normalize(cross(z, Vec3d{0, 0, 1})), y = cross(z, x);
    Camera c;
    c.width = c.height = 128;
    c.fx = c.fy = 200;
    c.cx = c.cy = 64;
    c.center = center;
    c.world_from_cam = {{{x.x, y.x, z.x}, {x.y, y.y, z.y}, {x.z, y.z, z.z}}};
    Image image(128, 128, 4);
    for (int v = 0; v < 128; ++v)
      for (int u = 0; u < 128; ++u) {
        double covered = 0, all = 0;
        for (int i = -7; i <= 7; ++i)
          for (int j = -7; j <= 7; ++j) {
            const Ray ray = c.ray(u + 0.5 + i / 8.0, v + 0.5 + j / 8.0);
            const double w = (8 - std::abs(i)) * (8 - std::abs(j));
            all += w;
            if (length(cross(ray.origin, ray.direction)) < radius) covered += w;
          }
        *(image.at(u, v) + 3) = soft ? float(covered / all) : covered > all / 2;
      }
    store.add_view(c, image, 3);
  }
  return store;
}

TEST(SilhouetteLevel, IsWhereThePicturesSayThatTheSurfaceIs) {
  const Device device = make_device("cpu");
  const Field field = ball_field();
  for (const float more : {-0.004f, 0.0f, 0.003f})
    EXPECT_NEAR(silhouette_level(device, field, pictures(kRadius + more, true), 0.01f, 1), more, 4e-4f);
  EXPECT_EQ(silhouette_level(device, field, pictures(kRadius + 0.003f, true), 0.001f, 1), 0.001f);
}

TEST(SilhouetteLevel, IsReadOffTheBordersOfMasksInBlackAndWhite) {
  const Device device = make_device("cpu");
  for (const float more : {-0.004f, 0.0f, 0.003f})
    EXPECT_NEAR(silhouette_level(device, ball_field(), pictures(kRadius + more, false), 0.01f, 1), more,
                6e-4f);
}

}  // namespace
}  // namespace cei3d
