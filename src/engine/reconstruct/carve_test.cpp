// SPDX-License-Identifier: Apache-2.0
// A box with a pit in its top: no silhouette shows the pit, the colours do.
#include "engine/reconstruct/carve.h"

#include <gtest/gtest.h>

#include <cmath>

#include "core/math/vec.h"

namespace cei3d {
namespace {

bool in_pit(Vec3f p) { return std::abs(p.x) < 0.28f && std::abs(p.y) < 0.28f && p.z > 0.1f && p.z < 0.4f; }
// More than a cell of 0.05 from its walls, where the opening leaves none.
bool amid_pit(Vec3f p) { return std::abs(p.x) < 0.22f && std::abs(p.y) < 0.22f && p.z > 0.16f && p.z < 0.4f; }
bool in_box(Vec3f p) { return std::abs(p.x) < 0.45f && std::abs(p.y) < 0.45f && std::abs(p.z) < 0.4f; }
bool solid(Vec3f p) { return in_box(p) && !in_pit(p); }

Vec3f color_at(Vec3f p) {
  const bool dark = (int(std::floor(p.x * 8)) + int(std::floor(p.y * 8)) + int(std::floor(p.z * 8))) & 1;
  return dark ? Vec3f{0.1f, 0.1f, 0.3f} : Vec3f{0.8f, 0.6f, 0.2f};
}

Image picture(const Camera& camera) {
  Image image(camera.width, camera.height, 4);
  for (int y = 0; y < camera.height; ++y)
    for (int x = 0; x < camera.width; ++x) {
      const Ray ray = camera.ray(x + 0.5, y + 0.5);
      for (float t = 1.5f; t < 4; t += 0.01f) {
        const Vec3f p = ray.origin + ray.direction * t;
        if (!solid(p)) continue;
        const Vec3f c = color_at(p);
        float* out = image.at(x, y);
        out[0] = c.x, out[1] = c.y, out[2] = c.z, out[3] = 1;
        break;
      }
    }
  return image;
}

// From a sphere of radius 2.5 around the origin, looking at it.
Camera camera_at(double height, double turn) {
  const Vec3d z{std::sqrt(1 - height * height) * std::cos(turn), std::sqrt(1 - height * height) * std::sin(turn), height};
  Camera c;
  c.width = c.height = 48;
  c.fx = c.fy = 70;
  c.cx = c.cy = 24;
  c.center = z * 2.5;
  const Vec3d right = normalize(cross(Vec3d{0, 0, 1}, z)), down = cross(right, z);
  for (int k = 0; k < 3; ++k) c.world_from_cam.row[k] = {right[k], down[k], -z[k]};
  return c;
}

TEST(Carve, OpensAPitThatNoSilhouetteShows) {
  PixelStore pixels;
  for (int i = 0; i < 40; ++i) {
    const Camera c = camera_at(0.95 - 1.1 * i / 40, 2.39996 * i);
    pixels.add_view(c, picture(c), 6);
  }
  std::vector<HullMask> masks;
  for (size_t v = 0; v < pixels.cameras().size(); ++v) masks.push_back({pixels.cameras()[v], pixels.masks()[v]});
  const VisualHull hull = visual_hull(masks, 40);
  CarveOptions options;
  options.steps = 400;
  options.rays = 2048;
  const VisualHull carved = carve(pixels, hull, options);
  int pit = 0, opened = 0, body = 0, lost = 0;
  for (size_t i = 0; i < hull.inside.size(); ++i) {
    const auto at = [&](size_t k) { return (float(k) + 0.5f) * 2 / 40 - 1; };
    const Vec3f p{at(i % 40), at(i / 40 % 40), at(i / 1600)};
    EXPECT_LE(carved.inside[i], hull.inside[i]);
    if (!hull.inside[i]) continue;
    if (amid_pit(p)) ++pit, opened += !carved.inside[i];
    if (solid(p)) ++body, lost += !carved.inside[i];
  }
  EXPECT_GT(pit, 300);  // the hull has it filled
  EXPECT_GT(opened, 0.8 * pit);
  EXPECT_LT(lost, 0.15 * body);
  EXPECT_EQ(carve(pixels, hull, options).inside, carved.inside);
}

}  // namespace
}  // namespace cei3d
