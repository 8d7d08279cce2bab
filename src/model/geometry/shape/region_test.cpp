// SPDX-License-Identifier: Apache-2.0
#include "model/geometry/shape/region.h"

#include <gtest/gtest.h>

#include "core/base/json.h"
#include "core/math/ray_sphere.h"
#include "core/math/rng.h"
#include "model/geometry/shape/test_regions.h"

namespace cei3d {
namespace {

constexpr int kSize = 64;

// Looks at the origin of the unit frame from z = -3 along +z.
Camera front_camera() {
  Camera c;
  c.width = c.height = kSize;
  c.fx = c.fy = 80;
  c.cx = c.cy = kSize / 2;
  c.center = {0, 0, -3};
  return c;
}

constexpr float kRadius = 0.8f;

// First meeting of a ray with the sphere; negative: none.
float sphere_distance(const Ray& r) {
  const auto [near, far] = sphere_span(r, kRadius);
  return near < far ? near : -1;
}

// A disc painted on the sphere: mask of radius 10 pixels about the picture's center.
bool painted(double u, double v) { return square(u - kSize / 2) + square(v - kSize / 2) < 100; }

Region painted_disc(bool with_projector) {
  const Camera camera = front_camera();
  Projector p;
  p.camera = camera;
  p.alpha = p.depth = Image(kSize, kSize, 1);
  Region::Points points;
  for (int y = 0; y < kSize; ++y) {
    for (int x = 0; x < kSize; ++x) {
      const Ray ray = camera.ray(x + 0.5, y + 0.5);
      const float t = sphere_distance(ray);
      if (t < 0) continue;
      const Vec3f hit = ray.origin + ray.direction * t;
      *p.depth.at(x, y) = float(camera.project(to_double(hit)).z);
      if (!painted(x + 0.5, y + 0.5)) continue;
      *p.alpha.at(x, y) = 1;
      points.positions.push_back(hit);
      points.normals.push_back(normalize(hit));
      points.reach.push_back(0.06f);
    }
  }
  return Region(points, with_projector ? p : Projector{});
}

Vec3f random_on_sphere(int i) {
  Rng rng(5, 0, i);
  return normalize(Vec3f{rng.normal(), rng.normal(), rng.normal()}) * kRadius;
}

TEST(Region, OfPaintHoldsWhatTheCameraSeesInsideTheMask) {
  const Region region = painted_disc(true);
  const Camera camera = front_camera();
  int inside = 0;
  for (int i = 0; i < 20000; ++i) {
    const Vec3f p = random_on_sphere(i);
    const bool front = dot(normalize(p), normalize(to_float(camera.center) - p)) > 0.1f;
    const Vec3d s = camera.project(to_double(p));
    const double from_center = std::hypot(s.x - kSize / 2, s.y - kSize / 2);
    if (std::abs(from_center - 10) < 0.75) continue;  // the outline of a mask of whole pixels
    EXPECT_EQ(region.contains(p, normalize(p)), front && from_center < 10) << s.x << ' ' << s.y << ' ' << s.z;
    inside += front && from_center < 10;
  }
  EXPECT_GT(inside, 300);
}

TEST(Region, StraightBordersAreSharperThanAPixel) {
  Projector p;
  p.camera = front_camera();
  p.alpha = p.depth = Image(kSize, kSize, 1);
  for (int y = 0; y < kSize; ++y)
    for (int x = 0; x < kSize; ++x) {
      *p.alpha.at(x, y) = clamp(20.25f - float(x), 0.0f, 1.0f);  // covered left of u = 20.25
      *p.depth.at(x, y) = 3;
    }
  for (double u = 18.6; u < 22; u += 0.1) {
    const Ray ray = p.camera.ray(u, 30.3);
    const Vec3f on_plane = ray.origin + ray.direction * (3 / ray.direction.z);
    if (std::abs(u - 20.25) < 0.26) continue;
    EXPECT_EQ(p.covers(on_plane, {0, 0, -1}), u < 20.25) << u;
  }
}

TEST(Region, OfPaintLeavesHiddenAndAvertedSurfacesAlone) {
  const Region region = painted_disc(true);
  const Vec3f front{0, 0, -kRadius};
  EXPECT_TRUE(region.contains(front, {0, 0, -1}));
  EXPECT_FALSE(region.contains(-front, {0, 0, 1}));  // far side
  // A sheet just behind what the view shows.
  EXPECT_FALSE(region.contains(front + Vec3f{0, 0, 0.05f}, {0, 0, -1}));
  EXPECT_FALSE(region.contains(front, {0, 0, 1}));       // the back of the painted sheet
  EXPECT_FALSE(region.contains(front, {1, 0, -0.05f}));  // seen at a grazing angle
}

TEST(Region, WithoutPointsIsWhatTheProjectorCovers) {
  const Projector p = painted_disc(true).projector();
  const Region outline({}, p);
  Tensors tensors;
  Json head = Json::object();
  outline.save(tensors, head);
  const Region back = Region::load(tensors, head);
  int inside = 0;
  for (int i = 0; i < 5000; ++i) {
    const Vec3f x = random_on_sphere(i), n = normalize(x);
    EXPECT_EQ(outline.contains(x, n), p.covers(x, n));
    EXPECT_EQ(back.contains(x, n), p.covers(x, n));
    inside += outline.contains(x, n);
  }
  EXPECT_GT(inside, 20);
}

TEST(Region, OfPointsFollowsBruteForce) {
  const Region region = painted_disc(false);
  const Region::Points& h = region.points();
  for (int i = 0; i < 3000; ++i) {
    const Vec3f p = random_on_sphere(i), n = normalize(p);
    bool expected = false;
    for (size_t k = 0; k < h.positions.size(); ++k)
      expected |=
          dot(h.positions[k] - p, h.positions[k] - p) < square(h.reach[k]) && dot(h.normals[k], n) > 0;
    EXPECT_EQ(region.contains(p, n), expected);
  }
}

TEST(Region, OfPointsAndThoseBesideFollowsBruteForce) {
  Region::Points h = painted_disc(false).points();
  for (size_t k = 0; k < h.positions.size(); ++k) {
    h.edited.push_back(h.positions[k].x < 0.1f);
    h.reach[k] = h.edited[k] ? 0.03f + 0.01f * float(k % 5) : 0.3f;
  }
  const Region region(h);
  int inside = 0;
  for (int i = 0; i < 20000; ++i) {
    const Vec3f p = random_on_sphere(i), n = normalize(p);
    float nearest = 1e9f;
    bool expected = false;
    for (size_t k = 0; k < h.positions.size(); ++k) {
      const float d = dot(h.positions[k] - p, h.positions[k] - p);
      if (d >= square(h.reach[k]) || d >= nearest || dot(h.normals[k], n) <= 0) continue;
      nearest = d, expected = h.edited[k];
    }
    EXPECT_EQ(region.contains(p, n), expected);
    inside += expected;
  }
  EXPECT_GT(inside, 100);
}

TEST(Region, ComesBackFromTensorsAsItWas) {
  for (const bool with_projector : {false, true}) {
    const Region region = painted_disc(with_projector);
    Tensors tensors;
    Json head;
    region.save(tensors, head);
    const Region again = Region::load(tensors, Json::parse(head.dump()));
    for (int i = 0; i < 5000; ++i) {
      const Vec3f p = random_on_sphere(i);
      EXPECT_EQ(again.contains(p, normalize(p)), region.contains(p, normalize(p)));
    }
    Tensors again_tensors;
    Json again_head;
    again.save(again_tensors, again_head);
    EXPECT_EQ(again_head, head);
    ASSERT_EQ(again_tensors.size(), tensors.size());
    for (const auto& [name, t] : tensors) EXPECT_EQ(again_tensors.at(name).f32, t.f32) << name;
  }
}

TEST(Region, DamagedDataAreRefusedWithASentence) { expect_damage_is_refused(painted_disc(true)); }

TEST(Region, ByDefaultContainsNothing) { EXPECT_FALSE(Region().contains({0, 0, 0}, {0, 0, 1})); }

}  // namespace
}  // namespace cei3d
