// SPDX-License-Identifier: Apache-2.0
// Which surface a scribble changes: handler points refined and labeled by it, and paint that changes nothing.
#include <gtest/gtest.h>

#include <cmath>
#include <set>

#include "core/base/error_of.h"
#include "core/math/color.h"
#include "core/math/rng.h"
#include "engine/edit/paint.h"
#include "engine/edit/stroke.h"
#include "engine/render/scene_light.h"
#include "engine/render/sphere_scene.h"
#include "model/scene/appearance.h"

namespace cei3d {
namespace {

constexpr int kSize = 96, kX0 = 36, kX1 = 60, kY0 = 40, kY1 = 56;

Camera front() { return camera_towards_origin({0, -3, 0.3}, kSize); }

Image rectangle(Vec3f srgb) {
  Image s(kSize, kSize, 4);
  for (int y = kY0; y < kY1; ++y)
    for (int x = kX0; x < kX1; ++x) {
      for (int c = 0; c < 3; ++c) s.at(x, y)[c] = srgb[c];
      s.at(x, y)[3] = 1;
    }
  return s;
}

// Pixels outside the rectangle, negative inside.
double from_rectangle(Vec3f p) {
  const Vec3d s = front().project(to_double(p));
  return std::max(std::abs(s.x - 0.5 * (kX0 + kX1)) - 0.5 * (kX1 - kX0),
                  std::abs(s.y - 0.5 * (kY0 + kY1)) - 0.5 * (kY1 - kY0));
}

bool is_seen(Vec3f p) { return dot(normalize(p), normalize(to_float(front().center) - p)) > 0.1f; }

Vec3f random_point(int i) {
  Rng rng(3, 0, i);
  return normalize(Vec3f{rng.normal(), rng.normal(), rng.normal()}) * kSphereRadius;
}

PaintResult painted(const Scene& scene, const Image& rgba, Routing routing, float theta = 0) {
  PaintRequest r;
  r.scribbles = {{front(), rgba}};
  r.id = "0001-paint";
  r.routing = routing;
  r.theta = theta;
  Progress quiet;
  return paint(make_device(), scene, r, quiet);
}

const Vec3f kRed{0.784f, 0.118f, 0.157f};

TEST(Routing, LabeledPointsAreAsSharpAsAThirdOfAPixel) {
  const EditLayer layer = painted(sphere_with_handlers(), rectangle(kRed), Routing::points).layer;
  EXPECT_TRUE(layer.region.projector().empty());
  int inside = 0;
  for (int i = 0; i < 60000; ++i) {
    const Vec3f p = random_point(i);
    const double away = is_seen(p) ? from_rectangle(p) : 1e9;
    if (std::abs(away) < 0.35) continue;
    EXPECT_EQ(layer.contains(p, normalize(p)), away < 0) << away;
    inside += away < 0;
  }
  EXPECT_GT(inside, 300);
}

TEST(Routing, AFixedDistanceIsThePapersRule) {
  const float theta = 0.05f;
  const EditLayer near = painted(sphere_with_handlers(), rectangle(kRed), Routing::points, theta).layer;
  const Region::Points& h = near.region.points();
  for (int i = 0; i < 20000; ++i) {
    const Vec3f p = random_point(i);
    bool within = false;
    for (size_t k = 0; k < h.positions.size() && !within; ++k)
      within = length(h.positions[k] - p) < theta && dot(h.normals[k], normalize(p)) > 0;
    ASSERT_EQ(near.contains(p, normalize(p)), within);
  }
  EXPECT_NE(std::string(error_of([&] {
                          painted(sphere_with_handlers(), rectangle(kRed), Routing::both, theta);
                        }).what())
                .find("routing by points"),
            std::string::npos);
}

// The labeled points are those of H that the view shows, and new ones no nearer to them than the spacing.
TEST(Routing, TheScribbleRefinesAndLabelsTheHandlerPoints) {
  const Scene scene = sphere_with_handlers();
  const PaintResult result = painted(scene, rectangle(kRed), Routing::points);
  const Region::Points& points = result.layer.region.points();
  ASSERT_EQ(points.edited.size(), points.positions.size());
  EXPECT_EQ(result.report.points, points.edited_count());
  std::set<std::array<float, 3>> known;
  for (const Vec3f p : scene.handlers->positions) known.insert({p.x, p.y, p.z});
  size_t of_h = 0;
  for (size_t i = 0; i < points.positions.size(); ++i) {
    const Vec3f p = points.positions[i];
    of_h += known.count({p.x, p.y, p.z});
    const double away = from_rectangle(p);
    if (std::abs(away) > 0.3) {
      EXPECT_EQ(points.edited[i] != 0, away < 0) << away;
    }
  }
  EXPECT_GT(of_h, 20u);
  EXPECT_EQ(points.positions.size() - of_h, result.report.refined);
  for (const Vec3f p : scene.handlers->positions)
    if (is_seen(p) && from_rectangle(p) < -0.5) {
      EXPECT_TRUE(result.layer.contains(p, normalize(p)));
    }
}

// What the view shows as albedo, as an 8-bit image would store it.
Image shown(const Scene& scene) {
  const Device device = make_device();
  const Image albedo = shade_view(device, scene, trace_view(device, scene, front(), 2)).albedo;
  Image rgba = rectangle({0, 0, 0});
  for (size_t i = 0; i < rgba.data.size(); ++i)
    if (i % 4 < 3) rgba.data[i] = std::round(255 * srgb_from_linear(albedo.data[i])) / 255;
  return rgba;
}

TEST(Routing, PaintOfTheSurfacesOwnColorChangesNothing) {
  const Scene scene = sphere_with_handlers();
  const PaintResult null = painted(scene, shown(scene), Routing::both);
  EXPECT_EQ(null.report.unchanged_pixels, (kX1 - kX0) * (kY1 - kY0));
  EXPECT_EQ(null.report.painted_pixels, 0);
  const Device device = make_device();
  const GBuffer g = trace_view(device, scene, front(), 2);
  EXPECT_EQ(shade_view(device, with_layer(scene, null.layer), g).rgb.data,
            shade_view(device, scene, g).rgb.data);

  Image half = shown(scene);
  for (int y = kY0; y < kY1; ++y)
    for (int x = kX0; x < 48; ++x)
      for (int c = 0; c < 3; ++c) half.at(x, y)[c] = kRed[c];
  const EditLayer left = painted(scene, half, Routing::both).layer;
  for (int i = 0; i < 20000; ++i) {
    const Vec3f p = random_point(i);
    const double u = front().project(to_double(p)).x,
                 away = is_seen(p) ? std::max(from_rectangle(p), u - 48) : 1e9;
    if (std::abs(away) > 0.6) {
      EXPECT_EQ(left.contains(p, normalize(p)), away < 0) << away;
    }
  }
}

}  // namespace
}  // namespace cei3d
