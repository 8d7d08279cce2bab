// SPDX-License-Identifier: Apache-2.0
#include "model/material/change.h"

#include <gtest/gtest.h>

#include "core/math/rng.h"

namespace cei3d {
namespace {

constexpr Material kBelow{0.4f, 0.5f, 0.2f};

TEST(MaterialChange, ReplacesTheValuesItNames) {
  EXPECT_EQ(changed(kBelow, {}), kBelow);
  EXPECT_EQ(changed(kBelow, {.roughness = 0.9f}), (Material{0.9f, 0.5f, 0.2f}));
  EXPECT_EQ(changed(kBelow, {0.0f, 1.0f, 1.0f}), (Material{0, 1, 1}));
}

TEST(MaterialChange, ScalesTheRoughnessAndCutsItOffAtOne) {
  EXPECT_EQ(changed(kBelow, {.roughness_scale = 0.5f}), (Material{0.2f, 0.5f, 0.2f}));
  EXPECT_EQ(changed(kBelow, {.roughness_scale = 4.0f}).roughness, 1);
  EXPECT_EQ(changed(kBelow, {.roughness_scale = 0.0f}).roughness, 0);
  EXPECT_EQ(changed(kBelow, {.roughness_scale = 1.0f}), kBelow);
}

TEST(MaterialChange, BlendsWithWhatLiesBelow) {
  const MaterialChange quarter{.roughness = 0.8f, .metalness = 1.0f, .blend = 0.25f};
  const Material m = changed(kBelow, quarter);
  EXPECT_FLOAT_EQ(m.roughness, 0.5f);
  EXPECT_EQ(m.specular, kBelow.specular);
  EXPECT_FLOAT_EQ(m.metalness, 0.4f);
  EXPECT_FLOAT_EQ(changed(kBelow, {.roughness_scale = 2.0f, .blend = 0.5f}).roughness, 0.6f);
  EXPECT_EQ(changed(kBelow, {.roughness = 0.8f, .blend = 0.0f}), kBelow);
}

// Whatever is blended, a value that the change does not name keeps its bits, and all stay in range.
TEST(MaterialChange, KeepsWhatItDoesNotNameBitForBit) {
  for (int i = 0; i < 1000; ++i) {
    Rng rng(1, 2, i);
    const Material below{rng.uniform(), rng.uniform(), rng.uniform()};
    MaterialChange c{.roughness_scale = 3 * rng.uniform(), .blend = rng.uniform()};
    const Material m = changed(below, c);
    EXPECT_EQ(m.specular, below.specular);
    EXPECT_EQ(m.metalness, below.metalness);
    EXPECT_GE(m.roughness, 0);
    EXPECT_LE(m.roughness, 1);
  }
}

TEST(MaterialChange, CoversOnlyWhatItReplaces) {
  MaterialValues covered;
  cover(covered, {.roughness_scale = 0.5f});
  cover(covered, {.specular = 0.5f, .blend = 0.9f});
  EXPECT_TRUE(shows({.specular = 0.1f}, covered));
  cover(covered, {.roughness = 0.5f});
  EXPECT_FALSE(shows({.roughness_scale = 2.0f}, covered));
  EXPECT_TRUE(shows({.roughness = 0.1f, .metalness = 1.0f}, covered));
  cover(covered, {0.1f, 0.1f, 0.1f});
  EXPECT_FALSE(shows({0.2f, 0.2f, 0.2f}, covered));
}

TEST(Tint, KeepsTextureAndStaysInRange) {
  const Tint t{{0.6f, 0.1f, 0.2f}, true, {0.5f, 0.4f, 0.1f}};
  const Vec3f at_mean = tinted(t, t.mean);
  for (int c = 0; c < 3; ++c) EXPECT_NEAR(at_mean[c], t.color[c], 1e-6f);
  EXPECT_FLOAT_EQ(tinted(t, {0.25f, 0.8f, 0.05f}).x, 0.3f);
  EXPECT_EQ(tinted(t, {1, 1, 1}).x, 1);
}

TEST(Tint, BlendsWithWhatLiesBelow) {
  const Tint flat{{0.6f, 0.1f, 0.2f}, false, {1, 1, 1}, 0.25f};
  const Vec3f mixed = tinted(flat, {0.2f, 0.5f, 0.2f});
  EXPECT_FLOAT_EQ(mixed.x, 0.3f);
  EXPECT_FLOAT_EQ(mixed.y, 0.4f);
  EXPECT_EQ(mixed.z, 0.2f);
}

}  // namespace
}  // namespace cei3d
