// SPDX-License-Identifier: Apache-2.0
#include "model/scene/dual_albedo.h"

#include <gtest/gtest.h>

#include <cstring>

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

struct Layers {
  std::shared_ptr<const Field> base = random_field(1), red = random_field(2), blue = random_field(3);
  // The second overlaps the first; the third has no albedo of its own.
  std::vector<EditLayer> layers{{"0001-paint", ball({0, 0, 0.1f}, 0.5f), red},
                                {"0002-paint", ball({0.4f, 0, 0.1f}, 0.4f), blue},
                                {"0003-material", ball({0, 0.4f, 0.1f}, 0.4f), nullptr}};
};

TEST(RoutedAlbedo, TheLastLayerWithAnAlbedoWins) {
  const Layers s;
  const std::vector<Hit> hits = random_hits(3000);
  const RoutedAlbedo routed = routed_albedo(make_device(), *s.base, s.layers, hits);
  int seen[4] = {0, 0, 0, 0};
  for (size_t i = 0; i < hits.size(); ++i) {
    int layer = -1;
    const Field* field = s.base.get();
    for (int l = 0; l < 3; ++l) {
      if (!s.layers[l].region.contains(hits[i].position, hits[i].normal)) continue;
      layer = l;
      if (s.layers[l].albedo) field = s.layers[l].albedo.get();
    }
    ASSERT_EQ(routed.layer[i], layer);
    ASSERT_TRUE(same_bits(routed.albedo[i], value_at(*field, hits[i].position)));
    ++seen[layer + 1];
  }
  for (const int n : seen) EXPECT_GT(n, 50);
}

TEST(RoutedAlbedo, OutsideEveryRegionTheBaseIsBitIdenticalOnAllDevices) {
  const Layers s;
  const std::vector<Hit> hits = random_hits(5000);
  for (const Device& device : all_devices()) {
    const RoutedAlbedo before = routed_albedo(device, *s.base, {}, hits);
    const RoutedAlbedo after = routed_albedo(device, *s.base, s.layers, hits);
    for (size_t i = 0; i < hits.size(); ++i) {
      EXPECT_EQ(before.layer[i], -1);
      if (after.layer[i] >= 0) continue;
      EXPECT_TRUE(same_bits(before.albedo[i], after.albedo[i])) << device.name();
    }
  }
}

TEST(RoutedAlbedo, OfNothingIsNothing) {
  const Layers s;
  EXPECT_TRUE(routed_albedo(make_device(), *s.base, s.layers, {}).albedo.empty());
}

}  // namespace
}  // namespace cei3d
