// SPDX-License-Identifier: Apache-2.0
#include "model/scene/material_field.h"

#include <gtest/gtest.h>

namespace cei3d {
namespace {

TEST(MaterialField, OneMaterialIsTheSameEverywhere) {
  const Device device = make_device();
  const Material m{0.4f, 0.3f, 1};
  for (const Material& got : MaterialField(m).at(device, std::vector<Vec3f>(5, Vec3f{0.1f, 0, 0})))
    EXPECT_EQ(got, m);
}

TEST(MaterialField, OutputsAndMaterialsAreInverse) {
  for (const Material& m : {Material{0.05f, 0.5f, 0}, Material{0.3f, 0.5f, 0.4f}, Material{1, 0.5f, 1}}) {
    float outputs[MaterialField::kOutputs];
    outputs_for(m, outputs);
    const Material back = material_of(outputs, 0.5f);
    EXPECT_NEAR(back.roughness, m.roughness, 1e-6);
    EXPECT_NEAR(back.metalness, m.metalness, 1e-6);
  }
}

TEST(MaterialField, NearlyZeroAndNearlyOneAreExact) {
  const float nearly_dielectric[] = {0.5f, 0.06f}, nearly_metal[] = {0.5f, 0.93f};
  EXPECT_EQ(material_of(nearly_dielectric, 0.5f).metalness, 0);
  EXPECT_EQ(material_of(nearly_metal, 0.5f).metalness, 1);
}

TEST(MaterialField, GradientEqualsDifferences) {
  for (const float metalness : {0.03f, 0.4f, 0.8f, 0.97f}) {
    const Material d{0.7f, 0, -1.3f};
    const float at[] = {0.3f, metalness};
    float got[MaterialField::kOutputs];
    material_of_grad(at, d, got);
    for (int k = 0; k < MaterialField::kOutputs; ++k) {
      constexpr float kStep = 1e-3f;
      float up[] = {at[0], at[1]}, down[] = {at[0], at[1]};
      up[k] += kStep, down[k] -= kStep;
      const Material a = material_of(up, 0.5f), b = material_of(down, 0.5f);
      const float want =
          ((a.roughness - b.roughness) * d.roughness + (a.metalness - b.metalness) * d.metalness) /
          (2 * kStep);
      EXPECT_NEAR(got[k], want, 1e-3) << metalness << ' ' << k;
    }
  }
}

TEST(MaterialField, EveryPointHasItsOwnWhateverElseIsAsked) {
  const Device device = make_device();
  FieldConfig config;
  config.encoding.levels = 4;
  config.outputs = MaterialField::kOutputs;
  config.output_activation = Activation::sigmoid;
  const MaterialField field({0.3f, 0.7f, 0}, std::make_shared<const Field>(config, 3));
  const std::vector<Vec3f> points{{0.1f, 0.2f, 0.3f}, {-0.4f, 0, 0.5f}, {0.6f, -0.6f, 0}};
  const std::vector<Material> all = field.at(device, points);
  for (size_t i = 0; i < points.size(); ++i) {
    EXPECT_EQ(field.at(device, std::span(&points[i], 1))[0], all[i]);
    EXPECT_EQ(all[i].specular, 0.7f);
  }
  EXPECT_FALSE(all[0] == all[1]);
}

}  // namespace
}  // namespace cei3d
