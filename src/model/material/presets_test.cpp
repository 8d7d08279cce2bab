// SPDX-License-Identifier: Apache-2.0
#include "model/material/presets.h"

#include <gtest/gtest.h>

#include <cmath>
#include <set>
#include <string>

namespace cei3d {
namespace {

TEST(MaterialPresets, AreFoundByTheirNames) {
  std::set<std::string> names;
  for (const MaterialPreset& p : material_presets()) {
    EXPECT_EQ(find_material_preset(p.name), &p);
    EXPECT_TRUE(names.insert(p.name).second) << p.name;
  }
  EXPECT_GE(names.size(), 12u);
  EXPECT_EQ(find_material_preset("aluminum"), find_material_preset("aluminium"));
  EXPECT_EQ(find_material_preset("gol"), nullptr);
  EXPECT_EQ(find_material_preset(""), nullptr);
}

// Metals reflect much, the rest absorbs some; nothing reflects more than it gets.
TEST(MaterialPresets, ArePhysical) {
  for (const MaterialPreset& p : material_presets()) {
    const Material& m = p.material;
    EXPECT_TRUE(m.metalness == 0 || m.metalness == 1) << p.name;
    EXPECT_TRUE(m.roughness >= 0.05f && m.roughness <= 1) << p.name;
    for (int c = 0; c < 3; ++c) {
      EXPECT_GE(p.color[c], m.metalness == 1 ? 0.3f : 0.02f) << p.name;
      EXPECT_LE(p.color[c], m.metalness == 1 ? 1.0f : 0.85f) << p.name;
    }
  }
}

// Reflectance along the normal of a conductor, from its complex refractive index n + ik.
double reflectance(double n, double k) { return (std::pow(n - 1, 2) + k * k) / (std::pow(n + 1, 2) + k * k); }

// Indices near 633 nm (red) and 450 nm (blue), rounded. [Johnson and Christy 1972; Rakic 1995]
TEST(MaterialPresets, MetalsHaveTheColorsOfTheirRefractiveIndices) {
  const auto near = [](const char* name, double red, double blue) {
    const Vec3f color = find_material_preset(name)->color;
    EXPECT_NEAR(color.x, red, 0.08) << name;
    EXPECT_NEAR(color.z, blue, 0.08) << name;
  };
  near("gold", reflectance(0.18, 3.43), reflectance(1.38, 1.92));
  near("silver", reflectance(0.06, 4.2), reflectance(0.04, 2.65));
  near("copper", reflectance(0.25, 3.41), reflectance(1.17, 2.4));
  near("aluminum", reflectance(1.4, 7.5), reflectance(0.62, 5.5));
}

}  // namespace
}  // namespace cei3d
