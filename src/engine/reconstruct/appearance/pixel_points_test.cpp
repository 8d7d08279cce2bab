// SPDX-License-Identifier: Apache-2.0
#include "engine/reconstruct/appearance/pixel_points.h"

#include <gtest/gtest.h>

namespace cei3d {
namespace {

TEST(PixelPoints, LieOnTheTangentPlaneAndSpreadLikeTheFilter) {
  Hit hit;
  hit.position = {0.1f, -0.2f, 0.3f};
  hit.normal = normalize(Vec3f{0.3f, 0.8f, 0.5f});
  hit.to_camera = normalize(Vec3f{-0.2f, 0.5f, 0.9f});
  const float footprint = 0.01f;
  Vec3f mean{0, 0, 0};
  float along[2] = {0, 0};  // mean squares along two directions across the line of sight
  const Vec3f a = normalize(cross(hit.to_camera, Vec3f{1, 2, 3})), b = cross(hit.to_camera, a);
  for (const Vec3f p : pixel_points(hit, footprint)) {
    const Vec3f d = p - hit.position;
    EXPECT_NEAR(dot(d, hit.normal), 0, 1e-7);
    mean += d * 0.25f;
    along[0] += dot(d, a) * dot(d, a) / 4;
    along[1] += dot(d, b) * dot(d, b) / 4;
  }
  EXPECT_NEAR(length(mean), 0, 1e-7);
  // Second moment of a tent of radius r: r^2 / 6.
  for (const float m : along) EXPECT_NEAR(m, footprint * footprint / 6, 1e-3 * footprint * footprint);
}

}  // namespace
}  // namespace cei3d
