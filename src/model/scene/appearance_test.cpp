// SPDX-License-Identifier: Apache-2.0
#include "model/scene/appearance.h"

#include <gtest/gtest.h>

#include <cstring>
#include <optional>
#include <set>
#include <tuple>

#include "core/math/rng.h"

namespace cei3d {
namespace {

std::shared_ptr<const Field> random_field(uint64_t seed) {
  FieldConfig c;
  c.encoding.levels = 4;
  c.output_activation = Activation::sigmoid;
  auto field = std::make_shared<Field>(c, seed);
  for (Param& p : field->params().all())
    for (size_t i = 0; i < p.value.size(); ++i) p.value[i] += 0.3f * Rng(seed, 9, i).normal();
  return field;
}

// Everything within `radius` of a point, on surfaces that look up.
Region ball(Vec3f center, float radius) {
  Region::Points p;
  p.positions = {center};
  p.normals = {{0, 0, 1}};
  p.reach = {radius};
  return Region(p);
}

std::vector<Hit> random_hits(int n) {
  std::vector<Hit> hits(n);
  for (int i = 0; i < n; ++i) {
    Rng rng(6, 0, i);
    hits[i].position = {rng.uniform() * 2 - 1, rng.uniform() * 2 - 1, rng.uniform() * 0.2f};
    hits[i].normal = {0, 0, i % 5 ? 1.0f : -1.0f};
  }
  return hits;
}

Vec3f value_at(const Field& field, Vec3f x) {
  float v[3];
  field.eval(make_device(), std::span(&x, 1), v);
  return {v[0], v[1], v[2]};
}

bool same_bits(Vec3f a, Vec3f b) { return std::memcmp(&a, &b, sizeof(Vec3f)) == 0; }

EditLayer layer(const std::string& id, Region region) {
  EditLayer l;
  l.id = id;
  l.region = std::move(region);
  return l;
}

// Base and branches are fields of their own; the second region overlaps the first, the third touches both,
// the fourth is everywhere.
Scene layered_scene() {
  Scene s;
  s.albedo = random_field(1);
  s.material = Material{0.3f, 0.5f, 0};
  EditLayer red = layer("0001-paint", ball({0, 0, 0.1f}, 0.5f)),
            blue = layer("0002-paint", ball({0.4f, 0, 0.1f}, 0.4f));
  red.albedo = random_field(2);
  red.material.metalness = 1;
  blue.albedo = random_field(3);
  EditLayer tint = layer("0003-part", ball({0, 0.4f, 0.1f}, 0.4f));
  tint.tint = Tint{{0.6f, 0.1f, 0.2f}, true, {0.5f, 0.4f, 0.3f}};
  tint.material.roughness_scale = 0.7f;
  EditLayer whole = layer("0004-material", {});
  whole.everywhere = true;
  whole.material.specular = 0.9f;
  s.layers = {red, blue, tint, whole};
  return s;
}

// The layers one after the other, for one hit alone.
struct Expected {
  Vec3f albedo;
  Material material;
  int layer = -1;
};
Expected one_by_one(const Scene& s, const Hit& hit) {
  Expected e{value_at(*s.albedo, hit.position), s.material.mean()};
  for (int l = 0; l < int(s.layers.size()); ++l) {
    const EditLayer& layer = s.layers[l];
    if (!layer.everywhere && !layer.region.contains(hit.position, hit.normal)) continue;
    if (!layer.everywhere) e.layer = l;
    if (layer.albedo) e.albedo = value_at(*layer.albedo.use(), hit.position);
    if (layer.tint) e.albedo = tinted(*layer.tint, e.albedo);
    if (layer.erase_material) e.material = s.material.mean();
    e.material = changed(e.material, layer.material);
  }
  return e;
}

TEST(Appearance, IsThatOfTheLayersOneAfterTheOther) {
  const Scene s = layered_scene();
  const std::vector<Hit> hits = random_hits(20000);
  const Appearance got = appearance_at(make_device(), s, hits);
  int seen[4] = {0, 0, 0, 0};
  std::set<std::tuple<float, float, float>> materials;
  for (size_t i = 0; i < hits.size(); ++i) {
    const Expected e = one_by_one(s, hits[i]);
    const Material& m = got.material[i];
    ASSERT_EQ(got.layer[i], e.layer);
    ASSERT_TRUE(same_bits(got.albedo[i], e.albedo));
    ASSERT_EQ(m, e.material);
    materials.insert({m.roughness, m.specular, m.metalness});
    ++seen[e.layer + 1];
  }
  for (const int n : seen) EXPECT_GT(n, 50);
  EXPECT_EQ(materials.size(), 4u);  // 2 x 2 of what lies below the last layer, which is everywhere
}

// Replaces, scales, blends or leaves each value, at random.
MaterialChange random_change(uint64_t seed) {
  Rng rng(seed, 4, 1);
  const auto maybe = [&]() { return rng.below(2) ? std::optional(rng.uniform()) : std::nullopt; };
  MaterialChange c{maybe(), maybe(), maybe(), std::nullopt, rng.below(2) ? 1 : rng.uniform()};
  if (!c.roughness && rng.below(2)) c.roughness_scale = 2 * rng.uniform();
  return c;
}

// Many small layers, most of them away from the hits of a batch.
TEST(Appearance, IsThatOfTheLayersNearTheHits) {
  Scene s;
  s.albedo = random_field(1);
  for (uint64_t l = 0; l < 60; ++l) {
    Rng rng(7, 3, l);
    s.layers.push_back(
        layer("x", ball({2 * rng.uniform() - 1, 2 * rng.uniform() - 1, 0.1f}, 0.1f + 0.2f * rng.uniform())));
    s.layers.back().albedo = random_field(10 + l % 3);
    s.layers.back().material = random_change(l);
  }
  const std::vector<Hit> all = random_hits(4000);
  int edited = 0;
  for (const float x : {-1.0f, -0.5f, 0.0f, 0.5f}) {
    std::vector<Hit> hits;
    for (const Hit& h : all)
      if (h.position.x >= x && h.position.x < x + 0.25f && h.position.y > 0) hits.push_back(h);
    const Appearance got = appearance_at(make_device(), s, hits);
    for (size_t i = 0; i < hits.size(); ++i) {
      const Expected e = one_by_one(s, hits[i]);
      ASSERT_EQ(got.layer[i], e.layer);
      ASSERT_EQ(got.material[i], e.material);
      ASSERT_TRUE(same_bits(got.albedo[i], e.albedo));
      edited += e.layer >= 0;
    }
  }
  EXPECT_GT(edited, 200);
}

TEST(Appearance, ScaledAndBlendedMaterialsAreAppliedFromTheBottomUp) {
  const std::vector<Hit> hits = random_hits(500);
  for (uint64_t stack = 0; stack < 20; ++stack) {
    Scene s;
    s.albedo = random_field(1);
    for (uint64_t l = 0; l < 6; ++l) {
      Rng rng(stack, 3, l);
      s.layers.push_back(
          layer("x", ball({rng.uniform() - 0.5f, rng.uniform() - 0.5f, 0.1f}, 0.3f + 0.6f * rng.uniform())));
      s.layers.back().everywhere = rng.below(5) == 0;
      s.layers.back().material = random_change(10 * stack + l);
      s.layers.back().erase_material = rng.below(5) == 0;
    }
    const Appearance got = appearance_at(make_device(), s, hits);
    for (size_t i = 0; i < hits.size(); ++i) {
      const Expected e = one_by_one(s, hits[i]);
      ASSERT_EQ(got.material[i], e.material) << stack << ' ' << i;
      ASSERT_EQ(got.layer[i], e.layer);
    }
  }
}

TEST(Appearance, AScaleBelowAReplacementIsNotSeenAndAboveItIs) {
  Scene s;
  s.albedo = random_field(1);
  EditLayer set = layer("x", {}), half = set;
  set.everywhere = half.everywhere = true;
  set.material.roughness = 0.8f;
  half.material.roughness_scale = 0.5f;
  const std::vector<Hit> hits = random_hits(1);
  s.layers = {half, set};
  EXPECT_EQ(appearance_at(make_device(), s, hits).material[0].roughness, 0.8f);
  s.layers = {half, set, half, half};
  EXPECT_EQ(appearance_at(make_device(), s, hits).material[0].roughness, 0.2f);
}

TEST(Appearance, OutsideEveryRegionTheBaseIsBitIdenticalOnAllDevices) {
  Scene edited = layered_scene();
  edited.layers.pop_back();
  Scene base = edited;
  base.layers.clear();
  const std::vector<Hit> hits = random_hits(20000);
  for (const Device& device : all_devices()) {
    const Appearance before = appearance_at(device, base, hits), after = appearance_at(device, edited, hits);
    for (size_t i = 0; i < hits.size(); ++i) {
      EXPECT_EQ(before.layer[i], -1);
      if (after.layer[i] >= 0) continue;
      EXPECT_TRUE(same_bits(before.albedo[i], after.albedo[i])) << device.name();
      EXPECT_EQ(after.material[i], before.material[i]);
    }
  }
}

TEST(Appearance, AReplacingTintLeavesNothingOfWhatIsBelow) {
  Scene s = layered_scene();
  EditLayer flat = layer("0005-material", {});
  flat.everywhere = true;
  flat.tint = Tint{{0.2f, 0.4f, 0.1f}, false, {1, 1, 1}};
  s.layers.push_back(flat);
  for (const Vec3f a : appearance_at(make_device(), s, random_hits(200)).albedo)
    EXPECT_TRUE(same_bits(a, {0.2f, 0.4f, 0.1f}));
}

bool same(const Appearance& a, const Appearance& b) {
  if (a.layer != b.layer || a.material != b.material || a.unlit != b.unlit) return false;
  for (size_t i = 0; i < a.albedo.size(); ++i)
    if (!same_bits(a.albedo[i], b.albedo[i])) return false;
  return a.albedo.size() == b.albedo.size();
}

// Scenes that share layers, lose some, get others, and layers without a name.
std::vector<Scene> related_scenes() {
  Scene whole = layered_scene();
  for (EditLayer& l : whole.layers) l.content = l.id;
  EditLayer glow = layer("0005-paint", ball({-0.2f, 0, 0.1f}, 0.3f)), nameless = glow;
  glow.content = "glow";
  glow.albedo = nameless.albedo = random_field(6);
  glow.unlit = true;
  std::vector<Scene> scenes(6, whole);
  scenes[0].layers.resize(1);
  scenes[1].layers.resize(3);
  scenes[2].layers = {whole.layers[0], whole.layers[2], glow};
  scenes[3].layers = {whole.layers[0], whole.layers[2], nameless};
  scenes[4].layers.erase(scenes[4].layers.begin());
  return scenes;
}

TEST(Appearance, AfterAnotherSceneHasTheBitsOfOneMadeAnew) {
  const Device device = make_device();
  const std::vector<Hit> hits = random_hits(2000);
  const std::vector<Scene> scenes = related_scenes();
  for (const Scene& before : scenes)
    for (const Scene& after : scenes)
      EXPECT_TRUE(same(
          appearance_after(device, after, hits, AppearanceKey(before), appearance_at(device, before, hits)),
          appearance_at(device, after, hits)));
}

TEST(Appearance, LayersOnAShelfGiveTheSameBits) {
  const Device device = make_device();
  const std::vector<Hit> hits = random_hits(2000);
  const Scene scene = layered_scene();
  Scene there = scene;
  const auto shelf = std::make_shared<Shelf>(1);  // room for one value
  for (EditLayer& l : there.layers) l = shelved(l, shelf, l.id, [l] { return l; });
  for (int round = 0; round < 2; ++round)
    EXPECT_TRUE(same(appearance_at(device, there, hits), appearance_at(device, scene, hits)));
  EXPECT_GT(shelf->reads(), 3u);
  // Each region and each network at most once a round, whatever the number of hits.
  size_t values = 0;
  for (const EditLayer& l : there.layers) values += 2 + l.also.size();
  EXPECT_LE(shelf->reads(), 2 * values);
}

TEST(Appearance, OfNothingIsNothing) {
  EXPECT_TRUE(appearance_at(make_device(), layered_scene(), {}).albedo.empty());
}

}  // namespace
}  // namespace cei3d
