// SPDX-License-Identifier: Apache-2.0
#include "engine/edit/paint.h"

#include <gtest/gtest.h>

#include <cstring>

#include "core/base/error.h"
#include "core/math/color.h"
#include "core/math/ray_sphere.h"
#include "core/math/rng.h"
#include "core/math/sub_pixel.h"
#include "engine/edit/relearn.h"
#include "engine/edit/stroke.h"
#include "engine/render/scene_light.h"
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
  return paint(make_device(), scene, {{{front(), two_colors()}}, "0001-paint"}, quiet);
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
    const Vec3f p = ray.origin + ray.direction * sphere_span(ray, kRadius).near;
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

// Whether any sample within one pixel of the center of pixel p, all that its color is made of, lies in the
// region.
bool touches(const GBuffer& g, size_t p, const Region& region) {
  const int x = int(p) % g.width, y = int(p) / g.width;
  for (int qy = std::max(0, y - 1); qy <= std::min(g.height - 1, y + 1); ++qy)
    for (int qx = std::max(0, x - 1); qx <= std::min(g.width - 1, x + 1); ++qx) {
      const size_t q = size_t(qy) * g.width + qx;
      for (uint32_t h = g.pixel_start[q]; h < g.pixel_start[q + 1]; ++h) {
        const Vec2f at = sub_pixel(g.sub_pixels[h], g.samples[q]);
        if (std::abs(float(qx - x) + at.x - 0.5f) < 1 && std::abs(float(qy - y) + at.y - 0.5f) < 1 &&
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
  const PaintResult r = paint(make_device(), *before_, {{{front(), scribble}}, "x"}, quiet);
  EXPECT_EQ(r.report.missed_pixels, 5);
}

// A square of one color and alpha in the middle of the picture.
Image square(Vec3f srgb, float alpha, int half = 10) {
  Image s(kSize, kSize, 4);
  for (int y = kSize / 2 - half; y < kSize / 2 + half; ++y)
    for (int x = kSize / 2 - half; x < kSize / 2 + half; ++x) {
      for (int c = 0; c < 3; ++c) s.at(x, y)[c] = srgb[c];
      s.at(x, y)[3] = alpha;
    }
  return s;
}

Scene painted(const Scene& scene, const PaintRequest& request) {
  Progress quiet;
  return with_layer(scene, paint(make_device(), scene, request, quiet).layer);
}

// Hits in the middle of what a camera sees, by `half` pixels.
std::vector<Hit> middle_hits(const Scene& scene, const Camera& camera, int half) {
  const GBuffer g = trace_view(make_device(), scene, camera, 1);
  std::vector<Hit> hits;
  for (int y = kSize / 2 - half; y < kSize / 2 + half; ++y)
    for (int x = kSize / 2 - half; x < kSize / 2 + half; ++x)
      hits.push_back(g.hits[g.pixel_start[size_t(y) * kSize + x]]);
  return hits;
}

TEST_F(PaintTest, SemiTransparentPaintIsMixedWithWhatLiesBelow) {
  const Device device = make_device();
  const Scene twice = painted(*after_, {{{front(), square(kBlue, 0.3f)}}, "0002-paint"});
  const auto hits = middle_hits(*after_, front(), 8);
  const Appearance below = appearance_at(device, *after_, hits), above = appearance_at(device, twice, hits);
  const Vec3f blue = linear_from_srgb(kBlue);
  for (size_t i = 0; i < hits.size(); ++i)
    for (int c = 0; c < 3; ++c)
      EXPECT_NEAR(above.albedo[i][c], 0.7f * below.albedo[i][c] + 0.3f * blue[c], 0.3f * 0.02f);
  // The paint ends where the scribble ends.
  for (const auto& [x, y] : {std::pair{30, 30}, {70, 48}, {48, 60}}) {
    const Ray ray = front().ray(x, y);
    const Vec3f p = ray.origin + ray.direction * sphere_span(ray, kRadius).near;
    EXPECT_EQ(twice.layers[1].weight(p, normalize(p)), 0) << x;
  }
}

// A soft disc of one color as browsers store it: 8 bits of the color times alpha, divided by alpha again.
Image stored_by_a_browser(Vec3f color) {
  Image s(kSize, kSize, 4);
  for (int y = 0; y < kSize; ++y)
    for (int x = 0; x < kSize; ++x) {
      const float r = std::hypot(float(x) - 48, float(y) - 48) / 14, alpha = std::max(0.0f, 1 - r * r);
      float* p = s.at(x, y);
      p[3] = std::round(255 * alpha) / 255;
      for (int c = 0; c < 3; ++c)
        p[c] = p[3] > 0 ? std::min(1.0f, std::round(255 * color[c] * p[3]) / 255 / p[3]) : 0;
    }
  return s;
}

TEST_F(PaintTest, SoftPaintOfOneColorIsStoredAsThatColor) {
  const Image soft = stored_by_a_browser(kRed);
  float largest = 0;  // error of the color
  for (size_t i = 0; i < soft.data.size(); i += 4)
    if (soft.data[i + 3] > 0) largest = std::max(largest, std::abs(soft.data[i] - kRed.x));
  ASSERT_GT(largest, 20.0f / 255);
  const Scene scene = painted(*before_, {{{front(), soft}}, "0001-paint"});
  EXPECT_EQ(scene.layers[0].albedo->config().hidden_layers, 0);
  const std::vector<Hit> middle = middle_hits(scene, front(), 1);
  const Vec3f red = linear_from_srgb(kRed);
  for (const Vec3f a : appearance_at(make_device(), scene, middle).albedo) EXPECT_LT(length(a - red), 0.02f);
}

TEST_F(PaintTest, SmoothEdgesAreNotSemiTransparentPaint) {
  Image smooth = square(kRed, 1);
  for (int y = 30; y < 66; ++y) smooth.at(37, y)[3] = smooth.at(58, y)[3] = 0.25f + 0.5f * float(y % 2);
  for (int y = 0; y < kSize; ++y)
    for (int x = 0; x < kSize; ++x)
      if (y < 38 || y >= 58) smooth.at(x, y)[3] = 0;
  EXPECT_EQ(min_alpha(smooth), 0.5f);
  EXPECT_EQ(min_alpha(square(kRed, 1)), 0.5f);
  EXPECT_LT(min_alpha(square(kRed, 0.7f)), 1.0f / 255);
}

TEST_F(PaintTest, ALaterScribbleOfTheSameEditCoversAnEarlierOne) {
  const Device device = make_device();
  const Camera left = camera_at({-0.5, -2.96, 0.3});
  const Scene both = painted(*before_, {{{front(), square(kRed, 1)}, {left, square(kBlue, 1)}}, "x"});
  ASSERT_EQ(both.layers[0].also.size(), 1u);
  const auto check = [&](const Camera& camera, Vec3f expected, bool covered) {
    int seen = 0;
    for (const Hit& h : middle_hits(*before_, camera, 8)) {
      if (both.layers[0].also[0].contains(h.position, h.normal) != covered) continue;
      const Vec3d at = left.project(to_double(h.position));  // a pixel from the border of the later one
      if (std::abs(std::max(std::abs(at.x - 48), std::abs(at.y - 48)) - 10) < 1) continue;
      const Appearance a = appearance_at(device, both, std::span(&h, 1));
      for (int c = 0; c < 3; ++c) EXPECT_NEAR(a.albedo[0][c], linear_from_srgb(expected)[c], 0.06f);
      ++seen;
    }
    EXPECT_GT(seen, 30);
  };
  check(front(), kRed, false);
  check(front(), kBlue, true);
  check(left, kBlue, true);
}

TEST_F(PaintTest, ErasingShowsTheBaseAgainBitForBit) {
  const Device device = make_device();
  const Scene erased =
      painted(*after_, {.scribbles = {{front(), square(kRed, 1, 20)}}, .id = "x", .erase = true});
  const GBuffer g = trace_view(device, *before_, front(), 2);
  const Frame before = shade_view(device, *before_, g), after = shade_view(device, erased, g);
  EXPECT_EQ(before.rgb.data, after.rgb.data);  // the eraser covers all of the paint
  const Scene half =
      painted(*after_, {.scribbles = {{front(), square(kRed, 0.5f)}}, .id = "x", .erase = true});
  const auto hits = middle_hits(*before_, front(), 6);
  const Appearance base = appearance_at(device, *before_, hits), paint = appearance_at(device, *after_, hits),
                   mixed = appearance_at(device, half, hits);
  for (size_t i = 0; i < hits.size(); ++i)
    EXPECT_NEAR(mixed.albedo[i].x, 0.5f * (base.albedo[i].x + paint.albedo[i].x), 1e-5f);
}

TEST_F(PaintTest, TheViewShowsThePaintedColorWhereLightAllowsIt) {
  const Device device = make_device();
  const SceneLight light(device, *before_, scene_transports(*before_));
  const Vec3f dim{0.35f, 0.3f, 0.4f};  // sRGB; within reach of the light's specular floor and white
  Progress quiet;
  const PaintResult r = paint(
      device, *before_, {.scribbles = {{front(), square(dim, 1)}}, .id = "x", .seen_in = &light}, quiet);
  const Scene seen = with_layer(*before_, r.layer);
  const Frame f = shade_view(device, seen, trace_view(device, seen, front(), 2));
  EXPECT_EQ(r.report.out_of_reach, 0);
  for (int y = kSize / 2 - 8; y < kSize / 2 + 8; ++y)
    for (int x = kSize / 2 - 8; x < kSize / 2 + 8; ++x)
      for (int c = 0; c < 3; ++c) EXPECT_NEAR(f.rgb.at(x, y)[c], linear_from_srgb(dim)[c], 0.01f);
  const PaintResult bright =
      paint(device, *before_, {.scribbles = {{front(), square({1, 1, 1}, 1)}}, .id = "x", .seen_in = &light},
            quiet);
  EXPECT_GT(bright.report.out_of_reach, 0.9f);
}

// Distance of a point of the sphere from the rectangle of two_colors(), in pixels of the view; negative:
// inside.
double from_rectangle(Vec3f p) {
  const Vec3d s = front().project(to_double(p));
  return std::max(std::abs(s.x - 48) - 12, std::abs(s.y - 48) - 8);
}

PaintRequest routed(Routing routing) {
  PaintRequest r;
  r.scribbles = {{front(), two_colors()}};
  r.id = "x";
  r.routing = routing;
  return r;
}

TEST_F(PaintTest, WithoutRoutingTheScribbleIsLearnedAndTheUnseenSideChanges) {
  const Scene spilled = painted(*before_, routed(Routing::none));
  EXPECT_TRUE(spilled.layers[0].everywhere);
  std::vector<Hit> hits;
  for (int i = 0; i < 4000; ++i) {
    Rng rng(8, 0, i);
    const Vec3f n = normalize(Vec3f{rng.normal(), rng.normal(), rng.normal()});
    hits.push_back({n * kRadius, n, n, 0, 0, 0});
  }
  const Device device = make_device();
  const Appearance was = appearance_at(device, *before_, hits), is = appearance_at(device, spilled, hits);
  double inside = 0, beside = 0, unseen = 0;
  int n_inside = 0, n_beside = 0, n_unseen = 0;
  for (size_t i = 0; i < hits.size(); ++i) {
    const Vec3f p = hits[i].position;
    const bool seen = dot(hits[i].normal, normalize(to_float(front().center) - p)) > 0.2f;
    const double away = from_rectangle(p), x = front().project(to_double(p)).x;
    const Vec3f wanted = linear_from_srgb(x < 48 ? kRed : kBlue);
    if (seen && away < -2 && std::abs(x - 48) > 3) inside += length(is.albedo[i] - wanted), ++n_inside;
    if (seen && away > 6) beside += length(is.albedo[i] - was.albedo[i]), ++n_beside;
    if (!seen) unseen += length(is.albedo[i] - was.albedo[i]), ++n_unseen;
  }
  EXPECT_LT(inside / n_inside, 0.1);
  EXPECT_LT(beside / n_beside, 0.1);
  EXPECT_GT(unseen / n_unseen, 1.3 * beside / n_beside);
  Progress quiet;
  Scene reshaped = *before_;
  reshaped.shape_versions.resize(1);
  EXPECT_THROW(relearn(device, reshaped, {}, {}, 1, quiet), Error);
}

TEST_F(PaintTest, PaintedRadianceIsTheSameInEveryLight) {
  const Device device = make_device();
  PaintRequest request = routed(Routing::both);
  request.unlit = true;
  Scene scene = painted(*before_, request), dark = scene;
  dark.light.lobes = {{{0, 1, 0}, 5, {0.1f, 0.1f, 0.1f}}};
  const GBuffer g = trace_view(device, scene, front(), 2);
  const Frame before = shade_view(device, *before_, g), a = shade_view(device, scene, g),
              b = shade_view(device, dark, g);
  const Region& region = scene.layers[0].region;
  int inside = 0;
  for (int y = 0; y < kSize; ++y)
    for (int x = 0; x < kSize; ++x) {
      const size_t p = size_t(y) * kSize + x;
      if (!touches(g, p, region)) {
        EXPECT_TRUE(same_bytes(before.rgb, a.rgb, p));
        continue;
      }
      if (x < 38 || x >= 58 || std::abs(x - 48) < 3 || y < 42 || y >= 54) continue;
      ++inside;
      const Vec3f wanted = linear_from_srgb(x < 48 ? kRed : kBlue);
      for (int c = 0; c < 3; ++c) {
        EXPECT_NEAR(a.rgb.at(x, y)[c], wanted[c], 0.05f);
        EXPECT_EQ(a.rgb.at(x, y)[c], b.rgb.at(x, y)[c]);
        EXPECT_EQ(a.specular.at(x, y)[c], 0);
      }
    }
  EXPECT_GT(inside, 100);
  // Ordinary paint on top of it is lit again.
  const Scene covered = painted(scene, {{{front(), two_colors()}}, "y"}),
              plain = painted(*before_, {{{front(), two_colors()}}, "y"});
  EXPECT_EQ(shade_view(device, covered, g).rgb.data, shade_view(device, plain, g).rgb.data);
}

TEST_F(PaintTest, BadScribblesAreRefusedWithASentence) {
  const Scene& scene = *before_;
  EXPECT_NE(message_of(scene, {{{front(), Image(kSize, kSize / 2, 4, 1.0f)}}, "x"}).find("96x48"),
            std::string::npos);
  EXPECT_NE(message_of(scene, {{{front(), Image(kSize, kSize, 3, 1.0f)}}, "x"}).find("no alpha"),
            std::string::npos);
  EXPECT_NE(message_of(scene, {{{front(), Image(kSize, kSize, 4)}}, "x"}).find("opaque"), std::string::npos);
  Image corner(kSize, kSize, 4);
  corner.at(0, 0)[3] = 1;
  EXPECT_NE(message_of(scene, {{{front(), corner}}, "x"}).find("on the object"), std::string::npos);
}

}  // namespace
}  // namespace cei3d
