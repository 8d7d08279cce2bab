// SPDX-License-Identifier: Apache-2.0
#include "model/scene/appearance.h"

#include <gtest/gtest.h>

#include <cstring>
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
  tint.material.roughness = 0.7f;
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
    if (layer.albedo) e.albedo = value_at(*layer.albedo, hit.position);
    if (layer.tint) e.albedo = tinted(*layer.tint, e.albedo);
    e.material = changed(e.material, layer.material);
  }
  return e;
}

TEST(Appearance, IsThatOfTheLayersOneAfterTheOther) {
  const Scene s = layered_scene();
  const std::vector<Hit> hits = random_hits(3000);
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

TEST(Appearance, OutsideEveryRegionTheBaseIsBitIdenticalOnAllDevices) {
  Scene edited = layered_scene();
  edited.layers.pop_back();
  Scene base = edited;
  base.layers.clear();
  const std::vector<Hit> hits = random_hits(5000);
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

TEST(Appearance, OfNothingIsNothing) {
  EXPECT_TRUE(appearance_at(make_device(), layered_scene(), {}).albedo.empty());
}

TEST(Tint, KeepsTextureAndStaysInRange) {
  const Tint t{{0.6f, 0.1f, 0.2f}, true, {0.5f, 0.4f, 0.1f}};
  const Vec3f at_mean = tinted(t, t.mean);
  for (int c = 0; c < 3; ++c) EXPECT_NEAR(at_mean[c], t.color[c], 1e-6f);
  EXPECT_FLOAT_EQ(tinted(t, {0.25f, 0.8f, 0.05f}).x, 0.3f);
  EXPECT_EQ(tinted(t, {1, 1, 1}).x, 1);
}

}  // namespace
}  // namespace cei3d
