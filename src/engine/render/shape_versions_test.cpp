// SPDX-License-Identifier: Apache-2.0
// Pictures of objects whose shape was changed.
#include <gtest/gtest.h>

#include <cmath>
#include <cstring>

#include "engine/render/render.h"
#include "engine/render/scene_light.h"
#include "engine/render/sphere_scene.h"
#include "model/scene/appearance.h"

namespace cei3d {
namespace {

constexpr int kSize = 64;

Frame picture(const Scene& scene, const Camera& camera) {
  const Device device = make_device();
  return shade_view(device, scene, trace_view(device, scene, camera, 2));
}

EditLayer layer_of(Reshape r) {
  EditLayer layer;
  layer.id = "0001-deform";
  layer.reshape = std::make_shared<const Reshape>(std::move(r));
  return layer;
}

// Moves the vertices that `which` chooses by x -> turn x + lift.
template <class F>
Reshape moving(const Scene& scene, const Mat3f& turn, Vec3f lift, F which) {
  const Mesh& mesh = scene.surface->mesh();
  Reshape r;
  for (uint32_t v = 0; v < mesh.positions.size(); ++v) {
    if (!which(mesh.positions[v])) continue;
    r.moved.push_back(v);
    r.positions.push_back(turn * mesh.positions[v] + lift);
    r.normals.push_back(turn * mesh.normals[v]);
    const Vec3f* m = turn.row;
    r.gradients.push_back({m[0].x, m[0].y, m[0].z, m[1].x, m[1].y, m[1].z, m[2].x, m[2].y, m[2].z});
  }
  return r;
}

Mat3f about_z(float a) {
  return {{{std::cos(a), -std::sin(a), 0}, {std::sin(a), std::cos(a), 0}, {0, 0, 1}}};
}

// Root of the mean square, over the pixels both frames cover.
double difference(const Image& a, const Image& b) {
  double sum = 0, n = 0;
  for (size_t i = 0; i < a.data.size(); i += size_t(a.channels))
    for (int c = 0; c < a.channels; ++c, ++n) sum += square(double(a.data[i + c]) - b.data[i + c]);
  return std::sqrt(sum / n);
}

TEST(ChangedScene, AChangeOfNothingIsBitIdentical) {
  const Scene before = sphere_scene(), after = with_layer(before, layer_of({}));
  const Camera camera = camera_towards_origin({1, -3, 0.3}, kSize);
  const Frame a = picture(before, camera), b = picture(after, camera);
  for (const auto& [x, y] : {std::pair(&a.rgb, &b.rgb), {&a.normal, &b.normal}, {&a.depth, &b.depth}})
    EXPECT_EQ(x->data, y->data);
  EXPECT_EQ(std::count(b.edited.begin(), b.edited.end(), 1), 0);
}

TEST(ChangedScene, TurningTheObjectIsTurningCameraAndLight) {
  const Scene before = sphere_scene();
  const Mat3f turn = about_z(1.1f);
  const Scene turned =
      with_layer(before, layer_of(moving(before, turn, {0, 0, 0}, [](Vec3f) { return true; })));
  Scene around = before;
  around.light = rotated(before.light, transpose(turn));
  const Camera camera = camera_towards_origin({1, -3, 0.3}, kSize);
  Camera back = camera_towards_origin(
      {1 * std::cos(-1.1) + 3 * std::sin(-1.1), std::sin(-1.1) - 3 * std::cos(-1.1), 0.3}, kSize);
  const Frame a = picture(turned, camera), b = picture(around, back);
  EXPECT_LT(difference(a.albedo, b.albedo), 5e-4);
  EXPECT_LT(difference(a.mask, b.mask), 1e-3);
  EXPECT_LT(difference(a.depth, b.depth), 1e-3);
  EXPECT_LT(difference(a.rgb, b.rgb), 0.01);  // the sky's directions do not turn along
  EXPECT_GT(difference(picture(before, camera).albedo, b.albedo), 5e-3);  // else the test says nothing
}

// A paint-like layer: a flat color within a ball around a point of the surface.
EditLayer spot(Vec3f where, Vec3f color) {
  EditLayer layer;
  layer.id = "0002-spot";
  layer.region = Region({{where}, {normalize(where)}, {0.25f}, {}});
  layer.tint = Tint{color, false, {1, 1, 1}};
  return layer;
}

TEST(ChangedScene, PaintSticksToItsMatterWheneverTheShapeChanges) {
  const Scene plain = sphere_scene();
  const auto top = [](Vec3f p) { return p.z > 0.2f; };
  const Vec3f lift{0.15f, 0, 0.2f}, pole{0, 0, kSphereRadius}, red{0.9f, 0, 0}, blue{0, 0, 0.9f};
  const auto raise = [&](const Scene& s) {
    return with_layer(s, layer_of(moving(plain, about_z(0), lift, top)));
  };
  const Scene painted_first = raise(with_layer(plain, spot(pole, red)));
  const Scene painted_later = with_layer(raise(plain), spot(pole + lift, red));
  const Scene painted_below =
      with_layer(with_layer(raise(plain), spot(pole + lift, red)), spot({0, 0, -kSphereRadius}, blue));
  const Camera camera = camera_towards_origin({0.4, -0.8, 2.6}, kSize);
  const Frame a = picture(painted_first, camera), b = picture(painted_later, camera),
              c = picture(painted_below, camera);
  EXPECT_LT(difference(a.albedo, b.albedo), 1e-4);
  EXPECT_EQ(b.albedo.data, c.albedo.data);
  int red_pixels = 0;
  for (size_t p = 0; p < size_t(kSize) * kSize; ++p)
    red_pixels += a.albedo.data[4 * p] > 0.89f && a.albedo.data[4 * p + 2] < 0.01f;
  EXPECT_GT(red_pixels, 60);
}

// Whether any sample within one pixel of the center of pixel p meets something that the present version
// shaped.
bool near_change(const Scene& scene, const GBuffer& g, size_t p) {
  const int x = int(p) % g.width, y = int(p) / g.width;
  for (int qy = std::max(0, y - 1); qy <= std::min(g.height - 1, y + 1); ++qy)
    for (int qx = std::max(0, x - 1); qx <= std::min(g.width - 1, x + 1); ++qx) {
      const size_t q = size_t(qy) * g.width + qx;
      for (uint32_t h = g.pixel_start[q]; h < g.pixel_start[q + 1]; ++h)
        if (scene.shape_versions.back()->shaped_in(g.hits[h].triangle) > 0) return true;
    }
  return false;
}

// Samples of a pixel that meet nothing count as well: surface may have been there before.
bool same_place(const GBuffer& a, const GBuffer& b, size_t p) {
  const int x = int(p) % a.width, y = int(p) / a.width;
  for (int qy = std::max(0, y - 1); qy <= std::min(a.height - 1, y + 1); ++qy)
    for (int qx = std::max(0, x - 1); qx <= std::min(a.width - 1, x + 1); ++qx) {
      const size_t q = size_t(qy) * a.width + qx;
      if (a.pixel_start[q + 1] - a.pixel_start[q] != b.pixel_start[q + 1] - b.pixel_start[q]) return false;
      for (uint32_t i = a.pixel_start[q], j = b.pixel_start[q]; i < a.pixel_start[q + 1]; ++i, ++j)
        if (std::memcmp(&a.hits[i].position, &b.hits[j].position, sizeof(Vec3f)) != 0) return false;
    }
  return true;
}

TEST(ChangedScene, PixelsThatSeeNothingOfTheChangeAreBitIdentical) {
  const Device device = make_device();
  const Scene plain = sphere_scene();
  const auto right = [](Vec3f p) { return p.x > 0.35f; };
  const Scene once = with_layer(plain, layer_of(moving(plain, about_z(0.2f), {0.25f, 0, 0.1f}, right)));
  // A second change elsewhere leaves what the first one shaped alone, too.
  const auto left = [](Vec3f p) { return p.x < -0.35f; };
  const Scene twice = with_layer(once, layer_of(moving(once, about_z(-0.2f), {-0.2f, 0, 0}, left)));
  int same = 0, other = 0;
  for (const auto& [before, after, version] : {std::tuple(&plain, &once, 1), {&once, &twice, 2}})
    for (const Vec3d center : {Vec3d{0, -3, 0.3}, Vec3d{-1, 2, 2}}) {
      const Camera camera = camera_towards_origin(center, kSize);
      const GBuffer ga = trace_view(device, *before, camera, 2), gb = trace_view(device, *after, camera, 2);
      const Frame a = shade_view(device, *before, ga), b = shade_view(device, *after, gb);
      for (size_t p = 0; p < size_t(kSize) * kSize; ++p) {
        const bool touched = (version == 1 && near_change(*after, gb, p)) || !same_place(ga, gb, p);
        if (version == 1) {
          EXPECT_LE(bool(b.edited[p]), near_change(*after, gb, p));
        }
        ++(touched ? other : same);
        if (touched) continue;
        EXPECT_EQ(std::memcmp(a.rgb.at(int(p) % kSize, int(p) / kSize),
                              b.rgb.at(int(p) % kSize, int(p) / kSize), 16),
                  0);
      }
    }
  EXPECT_GT(same, 4 * kSize * kSize / 2);
  EXPECT_GT(other, 500);
}

// The upper cap is cut off and closed by a flat lid of its own color.
Scene with_lid(const Scene& scene, float height) {
  const Mesh& mesh = scene.surface->mesh();
  Reshape r;
  const uint32_t base = uint32_t(mesh.positions.size());
  for (uint32_t t = 0; t < mesh.triangles.size(); ++t) {
    const auto& c = mesh.triangles[t];
    if (mesh.positions[c[0]].z > height && mesh.positions[c[1]].z > height && mesh.positions[c[2]].z > height)
      r.removed.push_back(t);
  }
  const float radius = std::sqrt(kSphereRadius * kSphereRadius - height * height);
  constexpr int kCorners = 90;
  r.added_positions.push_back({0, 0, height});
  for (int i = 0; i < kCorners; ++i) {
    const float a = 2 * kPi * float(i) / kCorners;
    r.added_positions.push_back({radius * std::cos(a), radius * std::sin(a), height});
    r.added_triangles.push_back({base, base + 1 + uint32_t(i), base + 1 + uint32_t((i + 1) % kCorners)});
  }
  r.added_normals.assign(r.added_positions.size(), {0, 0, 1});
  r.added_colors.assign(r.added_positions.size(), {0.1f, 0.8f, 0.2f});
  return with_layer(scene, layer_of(std::move(r)));
}

TEST(ChangedScene, NewMatterHasItsOwnColorAndNormalAndCanBePainted) {
  const Scene cut = with_lid(sphere_scene(), 0.4f);
  const Camera camera = camera_towards_origin({0.1, -0.3, 3}, kSize);
  const auto middle = [&](const Image& i) { return i.at(kSize / 2, kSize / 2); };
  const Frame f = picture(cut, camera);
  EXPECT_NEAR(middle(f.albedo)[1], 0.8f, 1e-5f);
  EXPECT_NEAR(middle(f.normal)[2], 1, 1e-5f);
  EXPECT_NEAR(middle(f.depth)[0], (3 - 0.4) * std::sqrt(0.1 + 9) / 3, 0.02);
  EXPECT_EQ(f.edited[size_t(kSize) * kSize / 2 + kSize / 2], 1);
  // Paint made before the cut does not reach the lid, paint made after it does.
  const EditLayer red = spot({0, 0, 0.4f}, {0.9f, 0, 0});
  EXPECT_NEAR(middle(picture(with_lid(with_layer(sphere_scene(), red), 0.4f), camera).albedo)[1], 0.8f,
              1e-5f);
  EXPECT_NEAR(middle(picture(with_layer(cut, red), camera).albedo)[0], 0.9f, 1e-5f);
}

TEST(ChangedScene, WhatWasCutOffNoLongerShadesTheRest) {
  const Scene cut = with_lid(sphere_scene(), 0.4f);
  const auto transports = scene_transports(cut);
  ASSERT_EQ(transports.size(), 2u);
  const SkyRadiance sky = sky_radiance(cut.light);
  const auto seen = transports[1]->sky(sky), unoccluded = transports[1]->unoccluded_sky(sky, seen);
  const size_t lid = sphere_scene().surface->mesh().positions.size();  // its middle; it lay inside the sphere
  EXPECT_NEAR(seen[lid].x / unoccluded[lid].x, 1, 0.02f);
  EXPECT_EQ(seen[0].x, 0);  // did not change: not asked for
}

}  // namespace
}  // namespace cei3d
