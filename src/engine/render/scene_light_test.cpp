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
  s.material = Material{0.2f, 0.5f, 1};
  s.light.lobes = {{{0, 0, 1}, kBroadestLobe, {1, 1, 1}}, {{0, 0, -1}, kBroadestLobe, {1, 1, 1}}};
  auto orange = std::make_shared<Field>(s.albedo->config(), 2);
  for (Param& p : orange->params().all()) std::fill(p.value.begin(), p.value.end(), 0.0f);
  std::vector<float>& bias = orange->params().all().back().value;
  bias[0] = 3, bias[1] = 0, bias[2] = -3;
  s.albedo = orange;
  return s;
}

EditLayer grey(const Scene& scene, const std::string& id) {
  auto field = std::make_shared<Field>(scene.albedo->config(), 3);
  for (Param& p : field->params().all()) std::fill(p.value.begin(), p.value.end(), 0.0f);
  EditLayer layer;
  layer.id = id;
  layer.albedo = field;
  return layer;
}

EditLayer grey_everywhere(const Scene& scene) {
  EditLayer layer = grey(scene, "0001-paint");
  layer.everywhere = true;
  return layer;
}

// side: 1 the upper one, -1 the lower.
EditLayer grey_sphere(const Scene& scene, const std::string& id, float side) {
  Region::Points points;
  const Mesh& mesh = scene.surface->mesh();
  for (size_t v = 0; v < mesh.positions.size(); ++v) {
    if (mesh.positions[v].z * side < 0) continue;
    points.positions.push_back(mesh.positions[v]);
    points.normals.push_back(mesh.normals[v]);
    points.reach.push_back(0.05f);
  }
  EditLayer layer = grey(scene, id);
  layer.region = Region(points);
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
  // What is left is the light that arrives where a second reflection ends: it bounced off the unedited
  // colours.
  EXPECT_LT(mean_tint(SceneLight(device, after, transports).shade(hits, grey)), 0.4 * tint);
}

TEST(SceneLight, ALaterEditElsewhereLeavesWhatEditedPointsMirrorAlone) {
  const Device device = make_device();
  const Scene before = metal_scene();
  const auto upper = [&](const char* id) { return grey_sphere(before, id, 1); };
  const auto lower = [&](const char* id) { return grey_sphere(before, id, -1); };
  const Scene one = with_layer(before, upper("0001-paint")), two = with_layer(one, lower("0002-paint")),
              reversed = with_layer(with_layer(before, lower("0001-paint")), upper("0002-paint"));
  std::vector<Hit> hits = mirroring_hits(before);
  std::erase_if(hits, [](const Hit& h) { return h.position.z < 0; });
  ASSERT_GT(hits.size(), 100u);
  const auto transports = scene_transports(before);
  const auto specular = [&](const Scene& s) {
    return SceneLight(device, s, transports).shade(hits, appearance_at(device, s, hits)).specular;
  };
  const std::vector<Vec3f> first = specular(one), later = specular(two), last = specular(reversed);
  size_t others = 0;
  for (size_t i = 0; i < hits.size(); ++i) {
    for (int c = 0; c < 3; ++c) EXPECT_EQ(first[i][c], later[i][c]);
    others += length(first[i] - last[i]) > 1e-3f;
  }
  EXPECT_GT(others, hits.size() / 2);  // made after it, they mirror it
}

}  // namespace
}  // namespace cei3d
