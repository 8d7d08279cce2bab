// SPDX-License-Identifier: Apache-2.0
// The appearance stage (PPD): light and material of a standing surface, started by the linear split.
// [paper sec. 4.2; docs/method.md#appearance-stage]
#pragma once

#include <memory>

#include "core/base/progress.h"
#include "engine/reconstruct/appearance/linear_split.h"
#include "model/field/field.h"
#include "model/light/sg_mixture.h"
#include "model/scene/material_field.h"

namespace cei3d {

struct AppearanceInput {
  std::shared_ptr<const Surface> surface;
  SurfaceSamples samples;  // pixels wholly on the object
};

enum class Effort { brief, full };  // brief: fewer samples and steps, half the time

struct AppearanceOptions {
  Effort effort = Effort::full;
  int albedo_steps = -1;     // of the field under the split's light; -1: as `effort` says
  int joint_steps = -1;      // of field and light together; -1: as `effort` says
  int lobe_steps = 800;      // of the fit of lobes to the split's light
  int material_steps = 400;  // of the fit of a field to the split's materials
  float roughness = 0;       // > 0: known, not searched
  LightColorPrior light_color;
  uint64_t seed = 1;
  FieldConfig albedo;          // 3 outputs, sigmoid
  FieldConfig materials;       // MaterialField::kOutputs outputs, sigmoid
  int batch = 4096;            // pixels a step, of kPixelPoints each
  float network_rate = 2e-3f;  // Adam's, of the field's layers
};

struct AppearanceResult {
  SgMixture light;
  MaterialField material;
  std::shared_ptr<const Field> albedo;
  LinearSplit split;  // what it started from, for the record
};

AppearanceResult fit_appearance(const Device&, const AppearanceInput&, const AppearanceOptions&, Progress&);

// The albedo again, gently, on other samples: of a large capture, one random subset leaves a few samples to a
// texel, whose noise the field learns. result: of the same surface. About 30 seconds on two cores.
void refine_albedo(const Device&, const AppearanceInput&, const AppearanceOptions&, AppearanceResult& result,
                   Progress&, int steps = 600);

}  // namespace cei3d
