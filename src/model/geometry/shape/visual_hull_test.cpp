// SPDX-License-Identifier: Apache-2.0
#include "model/geometry/shape/visual_hull.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "core/base/error.h"

namespace cei3d {
namespace {

Camera camera_at(Vec3d eye) {
  Camera c;
  c.width = 100, c.height = 80;
  c.fx = 130, c.fy = 120, c.cx = 49, c.cy = 41, c.skew = 2;
  const Vec3d z = normalize(-eye), x = normalize(cross(z, Vec3d{0.1, 0.2, 1})), y = cross(z, x);
  c.world_from_cam = transpose(Mat3d{{x, y, z}});
  c.center = eye;
  return c;
}

// A ball of radius 0.6 around the origin, seen by 60 cameras.
struct Ball {
  std::vector<std::vector<uint8_t>> masks;
  std::vector<HullMask> views;
  Ball() {
    for (int i = 0; i < 60; ++i) {
      const double z = -0.9 + 1.8 * i / 59, r = std::sqrt(1 - z * z);
      const Camera c = camera_at(Vec3d{r * std::cos(2.4 * i), r * std::sin(2.4 * i), z} * 4.0);
      auto& mask = masks.emplace_back(size_t(c.width) * c.height);
      for (int y = 0; y < c.height; ++y)
        for (int x = 0; x < c.width; ++x) {
          const Vec3d d = to_double(c.ray(x + 0.5, y + 0.5).direction);
          mask[size_t(y) * c.width + x] = length(cross(c.center, d)) < 0.6;
        }
      views.push_back({c, {}});
    }
    for (size_t i = 0; i < views.size(); ++i) views[i].mask = masks[i];
  }
};

double volume(const VisualHull& hull) {
  const Vec3f size = hull.hi - hull.lo;
  double inside = 0;
  for (const uint8_t v : hull.inside) inside += v;
  return inside * double(size.x) * size.y * size.z / std::pow(hull.n, 3);
}

TEST(VisualHull, OfABallIsTheBall) {
  const Ball ball;
  const VisualHull hull = visual_hull(ball.views, 64);
  EXPECT_NEAR(volume(hull), 4 / 3.0 * 3.14159 * std::pow(0.6, 3), 0.05);
  for (size_t i = 0; i < hull.inside.size(); ++i) {
    const Vec3d cell{double(i % 64), double(i / 64 % 64), double(i / 64 / 64)};
    const double r = length((cell + Vec3d{0.5, 0.5, 0.5}) / 32.0 - Vec3d{1, 1, 1});
    EXPECT_TRUE(hull.inside[i] ? r < 0.66 : r > 0.57) << r;
  }
}

TEST(VisualHull, ABadMaskIsToleratedOnRequest) {
  Ball ball;
  std::fill(ball.masks[5].begin(), ball.masks[5].end(), uint8_t(0));
  EXPECT_EQ(volume(visual_hull(ball.views, 32)), 0);
  EXPECT_NEAR(volume(visual_hull(ball.views, 64, {-1, -1, -1}, {1, 1, 1}, 1)), 0.905, 0.06);
}

TEST(VisualHull, OutOfTheFrameIsNoEvidence) {
  Ball ball;
  for (HullMask& view : ball.views) view.camera.cx = 1e6;  // nobody sees anything
  EXPECT_EQ(volume(visual_hull(ball.views, 16)), 0);
  const Ball good;
  ball.views.insert(ball.views.end(), good.views.begin(), good.views.end());
  EXPECT_EQ(visual_hull(ball.views, 32).inside, visual_hull(good.views, 32).inside);
  EXPECT_EQ(volume(visual_hull(ball.views, 32, {-1, -1, -1}, {1, 1, 1}, 0, 61)), 0);
}

TEST(VisualHull, MaskOfAnotherSizeIsAnError) {
  Ball ball;
  ball.views[3].camera.width = 99;
  EXPECT_THROW(visual_hull(ball.views, 8), Error);
}

TEST(VisualHull, UnknownPixelsHaveNoVote) {
  Ball ball;
  const VisualHull whole = visual_hull(ball.views, 32, {-1, -1, -1}, {1, 1, 1}, 0, 20);
  std::fill(ball.masks[30].begin(), ball.masks[30].end(), kUnknown);
  const VisualHull without = visual_hull(ball.views, 32, {-1, -1, -1}, {1, 1, 1}, 0, 20);
  for (size_t i = 0; i < whole.inside.size(); ++i) EXPECT_LE(whole.inside[i], without.inside[i]);
  EXPECT_NEAR(volume(without), volume(whole), 0.02);
}

}  // namespace
}  // namespace cei3d
