// SPDX-License-Identifier: Apache-2.0
#include "engine/edit/paint.h"

#include <gtest/gtest.h>

#include <cstring>

#include "core/base/error.h"
#include "core/math/color.h"
#include "core/math/rng.h"
#include "engine/edit/stroke.h"
#include "engine/render/sphere_scene.h"
#include "model/scene/appearance.h"

namespace cei3d {
namespace {

constexpr float kRadius = kSphereRadius;
constexpr int kSize = 96;
const Vec3f kRed{0.784f, 0.118f, 0.157f}, kBlue{0.118f, 0.275f, 0.745f};  // sRGB

Camera camera_at(Vec3d center) { return camera_towards_origin(center, kSize); }
Camera front() { return camera_at({0, -3, 0.3}); }

// A rectangle, red left of column 48 and blue from there on.
Image two_colors() {
  Image s(kSize, kSize, 4);
  for (int y = 40; y < 56; ++y) {
    for (int x = 36; x < 60; ++x) {
      const Vec3f c = x < 48 ? kRed : kBlue;
      float* p = s.at(x, y);
      p[0] = c.x;
      p[1] = c.y;
      p[2] = c.z;
      p[3] = 1;
    }
  }
  return s;
}

PaintResult paint_two_colors(const Scene& scene) {
  Progress quiet;
  return paint(make_device(), scene, {front(), two_colors(), "0001-paint", 1}, quiet);
}

std::string message_of(const Scene& scene, const PaintRequest& request) {
  Progress quiet;
  try {
    paint(make_device(), scene, request, quiet);
  } catch (const Error& e) {
    return e.what();
  }
  return "";
}

class PaintTest : public ::testing::Test {
 protected:
  static void SetUpTestSuite() {
    before_ = new Scene(sphere_scene());
    result_ = new PaintResult(paint_two_colors(*before_));
    after_ = new Scene(*before_);
    after_->layers.push_back(result_->layer);
  }
  static void TearDownTestSuite() {
    delete before_;
    delete after_;
    delete result_;
  }
  static Scene *before_, *after_;
  static PaintResult* result_;
};
Scene* PaintTest::before_ = nullptr;
Scene* PaintTest::after_ = nullptr;
PaintResult* PaintTest::result_ = nullptr;

TEST_F(PaintTest, RegionIsTheScribbleOnTheSideThatTheViewSees) {
  const Camera camera = front();
  int inside = 0;
  for (int i = 0; i < 40000; ++i) {
    Rng rng(3, 0, i);
    const Vec3f n = normalize(Vec3f{rng.normal(), rng.normal(), rng.normal()}), p = n * kRadius;
    const Vec3d s = camera.project(to_double(p));
    const bool seen = dot(n, normalize(to_float(camera.center) - p)) > 0.1f;
    const double dx = std::abs(s.x - 48) - 12, dy = std::abs(s.y - 48) - 8, border = std::max(dx, dy);
    if (std::abs(border) < 0.3) continue;
    EXPECT_EQ(result_->layer.region.contains(p, n), seen && border < 0) << s.x << ' ' << s.y << ' ' << seen;
    inside += seen && border < 0;
  }
  EXPECT_GT(inside, 200);
}

TEST_F(PaintTest, ColorsComeOutExactWithASharpBorder) {
  const Camera camera = front();
  std::vector<Hit> hits;
  std::vector<Vec3f> expected;
  for (int i = 0; i < 4000; ++i) {
    Rng rng(4, 0, i);
    const double u = 36.5 + 23 * rng.uniform(), v = 40.5 + 15 * rng.uniform();
    if (std::abs(u - 48) < 1) continue;
    const Ray ray = camera.ray(u, v);
    const float b = dot(ray.origin, ray.direction), c = dot(ray.origin, ray.origin) - kRadius * kRadius;
    const Vec3f p = ray.origin + ray.direction * (-b - sqrt(b * b - c));
    hits.push_back({p, normalize(p), -ray.direction, 0, 0, 0});
    expected.push_back(linear_from_srgb(u < 48 ? kRed : kBlue));
  }
  const Appearance routed = appearance_at(make_device(), *after_, hits);
  double sum = 0;
  for (size_t i = 0; i < hits.size(); ++i) {
    EXPECT_EQ(routed.layer[i], 0);
    for (int c = 0; c < 3; ++c) {
      const float error = std::abs(routed.albedo[i][c] - expected[i][c]);
      EXPECT_LT(error, 0.05f);  // a pixel and more from the border
      sum += error;
    }
  }
  EXPECT_LT(sum / double(3 * hits.size()), 0.002);
  EXPECT_LT(result_->report.mean_error, 0.01f);
}

bool same_bytes(const Image& a, const Image& b, size_t pixel) {
  return std::memcmp(&a.data[pixel * a.channels], &b.data[pixel * b.channels], sizeof(float) * a.channels) ==
         0;
}

// Whether any sample within one pixel of the centre of pixel p, all that its colour is made of, lies in the
// region.
bool touches(const GBuffer& g, size_t p, const Region& region) {
  const int x = int(p) % g.width, y = int(p) / g.width;
  for (int qy = std::max(0, y - 1); qy <= std::min(g.height - 1, y + 1); ++qy)
    for (int qx = std::max(0, x - 1); qx <= std::min(g.width - 1, x + 1); ++qx) {
      const size_t q = size_t(qy) * g.width + qx;
      for (uint32_t h = g.pixel_start[q]; h < g.pixel_start[q + 1]; ++h) {
        const auto away = [&](int offset, int k) {
          return std::abs(float(offset) + (float(k) + 0.5f) / float(g.samples) - 0.5f);
        };
        const int k = g.sub_pixels[h];
        if (away(qx - x, k % g.samples) < 1 && away(qy - y, k / g.samples) < 1 &&
            region.contains(g.hits[h].position, g.hits[h].normal))
          return true;
      }
    }
  return false;
}

TEST_F(PaintTest, PixelsThatRouteToTheBaseAreBitIdentical) {
  const Device device = make_device();
  int edited_pixels = 0;
  for (const Vec3d center : {Vec3d{0, -3, 0.3}, Vec3d{1.5, -2.5, 1}, Vec3d{-2, -2, -1}, Vec3d{0.2, 3, 0.5}}) {
    const GBuffer traced = trace_view(device, *before_, camera_at(center), 2);
    const Frame before = shade_view(device, *before_, traced), after = shade_view(device, *after_, traced);
    for (size_t p = 0; p < size_t(kSize) * kSize; ++p) {
      const bool edited = touches(traced, p, result_->layer.region);
      EXPECT_EQ(bool(after.edited[p]), edited);
      edited_pixels += edited;
      if (edited) continue;
      EXPECT_TRUE(same_bytes(before.rgb, after.rgb, p));
      EXPECT_TRUE(same_bytes(before.albedo, after.albedo, p));
      EXPECT_TRUE(same_bytes(before.diffuse, after.diffuse, p));
      EXPECT_TRUE(same_bytes(before.specular, after.specular, p));
    }
  }
  EXPECT_GT(edited_pixels, 800);
}

TEST_F(PaintTest, TheSameSeedGivesTheSameBits) {
  const PaintResult again = paint_two_colors(*before_);
  const std::vector<Param>&a = again.layer.albedo->params().all(), &b = result_->layer.albedo->params().all();
  ASSERT_EQ(a.size(), b.size());
  for (size_t i = 0; i < a.size(); ++i) EXPECT_EQ(a[i].value, b[i].value) << a[i].name;
}

TEST_F(PaintTest, ReportsWhatWasPainted) {
  EXPECT_EQ(result_->report.painted_pixels, 16 * 24);
  EXPECT_EQ(result_->report.missed_pixels, 0);
  EXPECT_GT(result_->report.points, 16u * 24u);
}

TEST_F(PaintTest, PaintBesideTheObjectIsLeftOut) {
  Image scribble = two_colors();
  for (int x = 0; x < 5; ++x) scribble.at(x, 1)[3] = 1;
  Progress quiet;
  const PaintResult r = paint(make_device(), *before_, {front(), scribble, "x", 1}, quiet);
  EXPECT_EQ(r.report.missed_pixels, 5);
}

TEST_F(PaintTest, BadScribblesAreRefusedWithASentence) {
  const Scene& scene = *before_;
  EXPECT_NE(message_of(scene, {front(), Image(kSize, kSize / 2, 4, 1.0f), "x", 1}).find("96x48"),
            std::string::npos);
  EXPECT_NE(message_of(scene, {front(), Image(kSize, kSize, 3, 1.0f), "x", 1}).find("no alpha"),
            std::string::npos);
  EXPECT_NE(message_of(scene, {front(), Image(kSize, kSize, 4), "x", 1}).find("opaque"), std::string::npos);
  Image corner(kSize, kSize, 4);
  corner.at(0, 0)[3] = 1;
  EXPECT_NE(message_of(scene, {front(), corner, "x", 1}).find("on the object"), std::string::npos);
}

}  // namespace
}  // namespace cei3d
