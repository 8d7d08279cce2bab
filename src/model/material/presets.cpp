// SPDX-License-Identifier: Apache-2.0
#include "model/material/presets.h"

#include <algorithm>

namespace cei3d {
namespace {

constexpr float kUsual = kUsualSpecular;

// Colors of metals are published reflectances. All other values, including every roughness, are typical: real
// surfaces of the name vary widely.
constexpr MaterialPreset kPresets[] = {
    {"gold", {1.000f, 0.766f, 0.336f}, {0.20f, kUsual, 1}},      // [Lagarde 2011]
    {"silver", {0.972f, 0.960f, 0.915f}, {0.15f, kUsual, 1}},    // [Lagarde 2011]
    {"copper", {0.955f, 0.638f, 0.538f}, {0.25f, kUsual, 1}},    // [Lagarde 2011]
    {"aluminum", {0.913f, 0.922f, 0.924f}, {0.30f, kUsual, 1}},  // [Lagarde 2011]
    {"chrome", {0.549f, 0.556f, 0.554f}, {0.06f, kUsual, 1}},    // [Lagarde 2011]
    {"iron", {0.562f, 0.565f, 0.578f}, {0.45f, kUsual, 1}},      // [Akenine-Moeller et al. 2018, table 9.2]
    {"brass", {0.887f, 0.789f, 0.434f}, {0.25f, kUsual, 1}},     // [Palmqvist 2022]
    {"plastic", {0.600f, 0.600f, 0.600f}, {0.30f, kUsual, 0}},   // typical: light gray, half gloss
    {"rubber", {0.030f, 0.030f, 0.030f}, {0.85f, kUsual, 0}},    // typical: black
    {"clay", {0.420f, 0.180f, 0.100f}, {0.90f, 0.4f, 0}},        // typical: fired, unglazed, red
    {"ceramic", {0.800f, 0.790f, 0.760f}, {0.10f, kUsual, 0}},   // typical: white glaze
    {"wood", {0.300f, 0.160f, 0.080f}, {0.60f, kUsual, 0}},      // typical: planed, oiled
    {"leather", {0.150f, 0.070f, 0.040f}, {0.60f, kUsual, 0}},   // typical: brown
    {"stone", {0.350f, 0.340f, 0.320f}, {0.85f, kUsual, 0}},     // typical: gray, rough
    {"paper", {0.800f, 0.800f, 0.780f}, {1.00f, 0.3f, 0}},       // typical: uncoated
};

}  // namespace

std::span<const MaterialPreset> material_presets() { return kPresets; }

const MaterialPreset* find_material_preset(std::string_view name) {
  if (name == "aluminium") name = "aluminum";
  const auto* it = std::find_if(std::begin(kPresets), std::end(kPresets),
                                [&](const MaterialPreset& p) { return name == p.name; });
  return it == std::end(kPresets) ? nullptr : it;
}

}  // namespace cei3d
