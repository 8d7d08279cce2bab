// SPDX-License-Identifier: Apache-2.0
// What edited points see of one another: two metal spheres, one above the other.
#include "engine/render/scene_light.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "core/math/rng.h"
#include "engine/render/sphere_scene.h"
#include "model/scene/appearance.h"

namespace cei3d {
namespace {

Mesh two_spheres() {
  Mesh both = sphere_mesh(48, 96), other = both;
  const uint32_t first = uint32_t(both.positions.size());
  for (Vec3f& p : both.positions) p = p * 0.6f + Vec3f{0, 0, -0.45f};
  for (Vec3f& p : other.positions) p = p * 0.6f + Vec3f{0, 0, 0.45f};
  both.positions.insert(both.positions.end(), other.positions.begin(), other.positions.end());
  both.normals.insert(both.normals.end(), other.normals.begin(), other.normals.end());
  for (const auto& t : other.triangles) both.triangles.push_back({t[0] + first, t[1] + first, t[2] + first});
  return both;
}

// Coloured metal under a white sky.
Scene metal_scene() {
  Scene s = sphere_scene();
  s.surface = std::make_shared<Surface>(two_spheres());
  s.material = {0.2f, 0.5f, 1};
  s.light.lobes = {{{0, 0, 1}, kBroadestLobe, {1, 1, 1}}, {{0, 0, -1}, kBroadestLobe, {1, 1, 1}}};
  auto orange = std::make_shared<Field>(s.albedo->config(), 2);
  for (Param& p : orange->params().all()) std::fill(p.value.begin(), p.value.end(), 0.0f);
  std::vector<float>& bias = orange->params().all().back().value;
  bias[0] = 3, bias[1] = 0, bias[2] = -3;
  s.albedo = orange;
  return s;
}

EditLayer grey_everywhere(const Scene& scene) {
  auto grey = std::make_shared<Field>(scene.albedo->config(), 3);
  for (Param& p : grey->params().all()) std::fill(p.value.begin(), p.value.end(), 0.0f);
  EditLayer layer;
  layer.id = "0001-paint";
  layer.everywhere = true;
  layer.albedo = grey;
  return layer;
}

// Hits whose mirror direction meets the other sphere.
std::vector<Hit> mirroring_hits(const Scene& scene) {
  std::vector<Hit> out;
  for (const Hit& h : vertex_hits(scene.surface->mesh())) {
    Hit hit = h;
    const Vec3f side = normalize(cross(h.normal, Vec3f{0.3f, 0.8f, 0.1f}));
    hit.to_camera = normalize(h.normal + side * 0.8f);
    const Vec3f origin = h.position + h.normal * 2e-3f, mirror = mirror_direction(hit);
    Surface::RayHit far;
    scene.surface->intersect(std::span(&origin, 1), std::span(&mirror, 1), 0, std::span(&far, 1));
    if (far.t >= 0) out.push_back(hit);
  }
  return out;
}

double mean_tint(const Shading& s) {
  double sum = 0;
  for (const Vec3f& c : s.specular) sum += std::abs(c.x - c.z);
  return sum / double(s.specular.size());
}

TEST(SceneLight, EditedPointsMirrorEditedColours) {
  const Device device = make_device();
  const Scene before = metal_scene(), after = with_layer(before, grey_everywhere(before));
  const std::vector<Hit> hits = mirroring_hits(before);
  ASSERT_GT(hits.size(), 300u);
  const auto transports = scene_transports(before);
  const Appearance grey = appearance_at(device, after, hits);
  const double tint =
      mean_tint(SceneLight(device, before, transports).shade(hits, grey));  // orange is mirrored
  EXPECT_GT(tint, 0.05);
  // What is left is the light that arrives where a second reflection ends: it bounced off the unedited colours.
  EXPECT_LT(mean_tint(SceneLight(device, after, transports).shade(hits, grey)), 0.4 * tint);
}

}  // namespace
}  // namespace cei3d
