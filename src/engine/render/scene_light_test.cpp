// SPDX-License-Identifier: Apache-2.0
// What edited points see of one another: two metal spheres, one above the other.
#include "engine/render/scene_light.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstring>

#include "core/base/file.h"
#include "core/base/temp_folder.h"
#include "core/math/rng.h"
#include "engine/render/random_residual.h"
#include "engine/render/render_cache.h"
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

// Colored metal under a white sky.
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

EditLayer gray(const Scene& scene, const std::string& id) {
  auto field = std::make_shared<Field>(scene.albedo->config(), 3);
  for (Param& p : field->params().all()) std::fill(p.value.begin(), p.value.end(), 0.0f);
  EditLayer layer;
  layer.id = id;
  layer.albedo = field;
  return layer;
}

EditLayer gray_everywhere(const Scene& scene) {
  EditLayer layer = gray(scene, "0001-paint");
  layer.everywhere = true;
  return layer;
}

// side: 1 the upper one, -1 the lower.
EditLayer gray_sphere(const Scene& scene, const std::string& id, float side) {
  Region::Points points;
  const Mesh& mesh = scene.surface->mesh();
  for (size_t v = 0; v < mesh.positions.size(); ++v) {
    if (mesh.positions[v].z * side < 0) continue;
    points.positions.push_back(mesh.positions[v]);
    points.normals.push_back(mesh.normals[v]);
    points.reach.push_back(0.05f);
  }
  EditLayer layer = gray(scene, id);
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

TEST(SceneLight, EditedPointsMirrorEditedColors) {
  const Device device = make_device();
  const Scene before = metal_scene(), after = with_layer(before, gray_everywhere(before));
  const std::vector<Hit> hits = mirroring_hits(before);
  ASSERT_GT(hits.size(), 300u);
  const auto transports = scene_transports(before);
  const Appearance gray = appearance_at(device, after, hits);
  // Orange is mirrored.
  const double tint = mean_tint(SceneLight(device, before, transports).shade(hits, gray));
  EXPECT_GT(tint, 0.05);
  // What is left is the light that arrives where a second reflection ends: it bounced off the unedited
  // colors.
  EXPECT_LT(mean_tint(SceneLight(device, after, transports).shade(hits, gray)), 0.4 * tint);
}

TEST(SceneLight, ALaterEditElsewhereLeavesWhatEditedPointsMirrorAlone) {
  const Device device = make_device();
  const Scene before = metal_scene();
  const auto upper = [&](const char* id) { return gray_sphere(before, id, 1); };
  const auto lower = [&](const char* id) { return gray_sphere(before, id, -1); };
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

// Metal spheres with a residual that is not zero.
Scene scene_with_residual() {
  Scene s = metal_scene();
  s.residual = random_residual(*s.albedo, 0.2f);
  return s;
}

// Moves the upper sphere up.
EditLayer lifted(const Scene& scene, float by) {
  Reshape r;
  const Mesh& mesh = scene.surface->mesh();
  for (uint32_t v = 0; v < mesh.positions.size(); ++v) {
    if (mesh.positions[v].z < 0) continue;
    r.moved.push_back(v);
    r.positions.push_back(mesh.positions[v] + Vec3f{0, 0, by});
    r.normals.push_back(mesh.normals[v]);
    r.gradients.push_back({1, 0, 0, 0, 1, 0, 0, 0, 1});
  }
  EditLayer layer;
  layer.id = "deform";
  layer.reshape = std::make_shared<const Reshape>(std::move(r));
  return layer;
}

// One of ten edits; equal kinds are equal edits of an equal scene.
EditLayer some_edit(const Scene& scene, uint32_t kind) {
  EditLayer layer;
  layer.everywhere = kind == 2 || kind == 5 || kind == 6;
  switch (kind) {
    case 0:
    case 1:
      layer = gray_sphere(scene, "paint", kind == 0 ? 1 : -1);
      break;
    case 2:
      layer.tint = Tint{{0.1f, 0.3f, 0.5f}, true, {0.5f, 0.5f, 0.5f}};
      break;
    case 3:
    case 4:
      layer = gray_sphere(scene, "material", kind == 3 ? 1 : -1);
      layer.albedo = nullptr;
      layer.material.roughness = kind == 3 ? 0.5f : 0.9f;
      break;
    case 5:
      layer.material.metalness = 0;
      break;
    case 6:
      layer.light = scene.light;
      layer.light->lobes[0].mu = {2, 1, 0.5f};
      break;
    case 7:
      layer = gray_sphere(scene, "erase", 1);
      layer.albedo = nullptr;
      layer.erase = true;
      break;
    case 8:
      layer = gray_sphere(scene, "unlit", -1);
      layer.unlit = true;
      break;
    default:
      layer = lifted(scene, 0.05f);
  }
  layer.id = "edit" + std::to_string(kind);
  layer.content = layer.id;  // as if it were stored
  return layer;
}

bool same_bits(const Image& a, const Image& b) {
  return a.data.size() == b.data.size() &&
         std::memcmp(a.data.data(), b.data.data(), a.data.size() * sizeof(float)) == 0;
}

bool same_bits(const Frame& a, const Frame& b) {
  return same_bits(a.rgb, b.rgb) && same_bits(a.albedo, b.albedo) && same_bits(a.diffuse, b.diffuse) &&
         same_bits(a.specular, b.specular) && same_bits(a.normal, b.normal) && same_bits(a.depth, b.depth) &&
         same_bits(a.roughness, b.roughness) && same_bits(a.mask, b.mask) && a.edited == b.edited;
}

// Edits are put on and taken off at random; every frame is compared with one of which nothing was kept.
void expect_frames_as_without(RenderCache& frames, const Device& device, uint64_t seed, int steps) {
  std::vector<Scene> stack{scene_with_residual()};  // the last one is the object as it is
  const Camera cameras[] = {camera_towards_origin({1, -3, 0.3}, 32), camera_towards_origin({-2, 2, 1}, 32)};
  for (int step = 0; step < steps; ++step) {
    Rng rng(seed, 17, uint64_t(step));
    if (rng.below(3) == 0 && stack.size() > 1)
      stack.pop_back();
    else
      stack.push_back(with_layer(stack.back(), some_edit(stack.back(), rng.below(10))));
    const Scene& scene = stack.back();
    const Camera& camera = cameras[rng.below(2)];
    const int samples = 1 + int(rng.below(2));
    const auto view = frames.trace(scene, camera, samples);
    const Frame frame = frames.shade(scene, frames.light(scene), *view);
    const Frame plain = shade_view(device, scene, trace_view(device, scene, camera, samples));
    ASSERT_TRUE(same_bits(frame, plain)) << "seed " << seed << ", step " << step;
  }
}

TEST(RenderCache, FramesOfRandomHistoriesHaveTheBitsOfFramesMadeAnew) {
  const Device device = make_device();
  RenderCache frames(device);
  expect_frames_as_without(frames, device, 0, 12);
  EXPECT_GT(frames.light_count().found, 0u);
  EXPECT_GT(frames.view_count().found, 0u);
  EXPECT_GT(frames.hits_kept(), 0u);
  EXPECT_GT(frames.hits_lit(), 0u);
}

TEST(RenderCache, WithoutMemoryItStillGivesTheSameBits) {
  const Device device = make_device();
  RenderCache frames(device, {.transports = 0, .lights = 0, .views = 0, .colors = 0});
  expect_frames_as_without(frames, device, 2, 5);
}

TEST(RenderCache, ASecondFrameComputesNoLight) {
  const Device device = make_device();
  const Scene base = scene_with_residual();
  const Scene one = with_layer(base, some_edit(base, 0));
  const Camera camera = camera_towards_origin({1, -3, 0.3}, 32);
  RenderCache frames(device);
  const auto draw = [&](const Scene& s) { frames.shade(s, frames.light(s), *frames.trace(s, camera, 1)); };
  draw(base);
  const size_t hits = frames.hits_lit();
  EXPECT_GT(hits, 100u);
  EXPECT_EQ(frames.hits_kept(), 0u);
  draw(base);
  EXPECT_EQ(frames.hits_lit(), hits);
  EXPECT_EQ(frames.hits_kept(), hits);
  draw(one);  // the lower sphere stays as it was
  EXPECT_GT(frames.hits_kept(), hits);
  EXPECT_LT(frames.hits_lit(), 2 * hits);
  EXPECT_EQ(frames.light_count().missed, 1u);
  Scene relit = base;
  relit.light.lobes[0].mu = {2, 1, 0.5f};
  draw(relit);
  EXPECT_EQ(frames.light_count().missed, 2u);
  EXPECT_EQ(frames.transport_count().missed, 1u);
  EXPECT_EQ(frames.transport_count().found, 1u);
  EXPECT_EQ(frames.view_count().missed, 1u);
}

class VertexLightFilesTest : public ::testing::Test {
 protected:
  Frame frame(VertexLightFiles files, const Scene& scene) {
    RenderCache frames(device_, {}, std::move(files));
    const auto light = frames.light_to_keep(scene);
    Frame f = frames.shade(scene, light, *frames.trace(scene, camera_towards_origin({1, -3, 0.3}, 32), 1));
    transports_ = frames.transport_count().missed;
    return f;
  }
  size_t count() const {
    std::error_code error;
    std::filesystem::directory_iterator it(folder_.path(), error);
    return size_t(std::distance(begin(it), end(it)));
  }
  const Device device_ = make_device();
  TempFolder folder_;
  size_t transports_ = 0;  // that the last frame computed
};

TEST_F(VertexLightFilesTest, TheNextProgramComputesNoTransportAndGivesTheSameBits) {
  const Scene base = scene_with_residual(), edited = with_layer(base, some_edit(base, 0));
  const VertexLightFiles files(folder_.path(), "object", true);
  const Frame first = frame(files, base);
  EXPECT_EQ(transports_, 1u);
  EXPECT_TRUE(same_bits(frame(files, base), first));
  EXPECT_EQ(transports_, 0u);
  EXPECT_TRUE(same_bits(frame(files, edited), frame({}, edited)));
  frame({folder_.path(), "another object", false}, base);
  EXPECT_EQ(transports_, 1u);
  EXPECT_EQ(count(), 1u);  // files that may not be written
}

TEST_F(VertexLightFilesTest, DamagedFilesAreComputedAgainAndOldOnesGo) {
  Scene scene = scene_with_residual();
  const VertexLightFiles files(folder_.path(), "object", true);
  const Frame first = frame(files, scene);
  const auto file = std::filesystem::directory_iterator(folder_.path())->path();
  write_file_atomic(file, read_file(file).substr(0, 1000));
  EXPECT_TRUE(same_bits(frame(files, scene), first));
  EXPECT_EQ(transports_, 1u);
  for (size_t i = 0; i < VertexLightFiles::kMax + 2; ++i) {
    scene.light.lobes[0].mu.x += 0.1f;
    files.put(scene.light, VertexLight());
  }
  EXPECT_EQ(count(), VertexLightFiles::kMax);
}

TEST(Transport, KeepsItsSurface) {
  auto surface = std::make_shared<const Surface>(two_spheres());
  const std::weak_ptr<const Surface> alive = surface;
  auto transport = std::make_unique<Transport>(std::move(surface));
  surface.reset();
  ASSERT_FALSE(alive.expired());
  EXPECT_GT(
      transport->bounce(std::vector<Vec3f>(transport->surface().mesh().positions.size(), {1, 1, 1}))[0].x,
      -1);
  transport.reset();
  EXPECT_TRUE(alive.expired());
}

}  // namespace
}  // namespace cei3d
