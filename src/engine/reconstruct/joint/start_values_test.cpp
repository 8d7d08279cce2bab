// SPDX-License-Identifier: Apache-2.0
// What the paper states of the values that its descent begins from.
#include "engine/reconstruct/joint/start_values.h"

#include <gtest/gtest.h>

#include <cmath>

#include "core/math/rng.h"
#include "core/math/sg.h"

namespace cei3d {
namespace {

std::vector<Vec3f> random_points() {
  std::vector<Vec3f> x;
  for (uint64_t i = 0; i < 500; ++i) {
    Rng rng(4, 0, i);
    x.push_back({2 * rng.uniform() - 1, 2 * rng.uniform() - 1, 2 * rng.uniform() - 1});
  }
  return x;
}

TEST(StartValues, AreAsThePaperStatesThem) {
  const Device device = make_device();
  const JointObject o = start_values(device, preset_by_name("paper"), 7);
  for (const Vec3f a : o.albedo.eval3(device, random_points()))
    for (int c = 0; c < 3; ++c) EXPECT_NEAR(a[c], 0.5f, 0.15f);  // "about 0.5 at all locations"
  ASSERT_EQ(o.light.lobes.size(), 128u);
  double power = 0;
  float nearest = 4;  // squared distance of two axes
  for (const SgLobe& l : o.light.lobes) {
    EXPECT_EQ(l.mu.x, l.mu.y);  // "monochromatic"
    EXPECT_EQ(l.mu.x, l.mu.z);
    power += double(l.mu.x) * 2 * M_PI / double(l.lambda) * (1 - std::exp(-2 * double(l.lambda)));
    for (const SgLobe& other : o.light.lobes)
      if (&other != &l) nearest = std::min(nearest, dot(l.axis - other.axis, l.axis - other.axis));
  }
  EXPECT_NEAR(power, 2 * M_PI, 1e-3);
  EXPECT_GT(nearest, 0.5f * 4 * kPi / 128);  // spread evenly: a lattice's cells are 4 pi / 128 large
  const double gloss = 2 / std::pow(double(o.material.mean().roughness), 4);
  EXPECT_GE(gloss, 94.9);
  EXPECT_LE(gloss, 125.1);
  ASSERT_TRUE(o.gloss);
  EXPECT_GE(o.gloss->sharpness, 95);
  EXPECT_LE(o.gloss->sharpness, 125);
  EXPECT_GE(o.gloss->specular, 0.18f);
  EXPECT_LE(o.gloss->specular, 0.26f);
}

TEST(StartValues, AreRandomAndTheSameForASeed) {
  const Device device = make_device();
  Preset preset = preset_by_name("fast");
  const JointObject a = start_values(device, preset, 1), same = start_values(device, preset, 1),
                    b = start_values(device, preset, 2);
  EXPECT_EQ(a.light.lobes[5].lambda, same.light.lobes[5].lambda);
  EXPECT_NE(a.light.lobes[5].lambda, b.light.lobes[5].lambda);
  EXPECT_NE(a.material.mean().roughness, b.material.mean().roughness);
}

}  // namespace
}  // namespace cei3d
