// SPDX-License-Identifier: Apache-2.0
// Light, albedo and material of a finished surface: first by the linear separation, then by descent.
// [paper sec. 4.2; docs/method.md#appearance-stage]
#pragma once

#include <functional>
#include <memory>

#include "core/base/cancel.h"
#include "core/base/progress.h"
#include "engine/reconstruct/appearance/linear_split.h"
#include "engine/render/lighting.h"
#include "model/field/field.h"
#include "model/light/sg_mixture.h"
#include "model/scene/material_field.h"

namespace cei3d {

struct AppearanceInput {
  std::shared_ptr<const Surface> surface;
  SurfaceSamples samples;                           // pixels wholly on the object
  std::shared_ptr<const Transport> transport = {};  // of the surface; null: it is computed
};

// Called between steps of a descent with what it has reached; changes nothing.
using ShowAppearance =
    std::function<void(const Lighting&, const Field& albedo, const MaterialField& material)>;

enum class Effort { brief, full };  // brief: fewer samples and steps, half the time

struct AppearanceOptions {
  Effort effort = Effort::full;
  int albedo_steps = -1;           // steps on the albedo field under the separated light; -1: by `effort`
  int refine_steps = -1;           // steps on albedo, material and light together; -1: by `effort`
  double descent_share = 1;        // share of these steps that there is time for
  int lobe_steps = 800;            // steps of the fit of lobes to the separated light
  int material_steps = 400;        // steps of the fit of a field to the separated materials
  float roughness = 0;             // roughness of the object where it is known; 0: searched
  bool several_materials = false;  // whether an earlier estimate of the object found several
  LightColorPrior light_color;
  uint64_t seed = 1;
  FieldConfig albedo;          // 3 outputs, sigmoid
  FieldConfig materials;       // MaterialField::kOutputs outputs, sigmoid
  int batch = 4096;            // pixels per step, kPixelPoints points each
  float network_rate = 2e-3f;  // Adam rate of the field's layers
  ShowAppearance show{};       // may be empty
};

struct AppearanceResult {
  SgMixture light;
  MaterialField material;
  std::shared_ptr<const Field> albedo;
  LinearSplit split;  // the linear separation, for reports
};

// The linear separation, and from it lobes of light and a field of materials. The result has no albedo field.
AppearanceResult separate_light(const Device&, const AppearanceInput&, const AppearanceOptions&, Progress&);

// The state of a descent on the appearance between two of its steps.
struct DescentState {
  int64_t step = 0;
  Tensors tensors;  // empty: the descent has not begun
};
struct DescentStore {
  DescentState from{};          // the state to continue from
  std::function<bool()> due{};  // asked between steps whether to save; may be empty
  // Called when `due` says so, and before an interruption; may be empty.
  std::function<void(DescentState)> save{};

  // To be called between two steps; state() makes the DescentState that is saved. Error: interrupted.
  template <class State>
  void between_steps(const Progress& progress, const State& state) const {
    const bool stop = progress.cancelled();
    if (save && (stop || (due && due()))) save(state());
    if (stop) check_cancelled(progress);
  }
};

// Fits the albedo field under the separated light, then descends on albedo, material and light. result: light
// and material of separate_light(). vertex_albedo: LinearSplit::albedo.
void descend_on_appearance(const Device&, const AppearanceInput&, const AppearanceOptions&,
                           const std::vector<Vec3f>& vertex_albedo, AppearanceResult& result, Progress&,
                           const DescentStore& = {});

// separate_light(), then descend_on_appearance().
AppearanceResult fit_appearance(const Device&, AppearanceInput, const AppearanceOptions&, Progress&);

std::shared_ptr<const Transport> transport_of(const AppearanceInput&, const Progress&);

// Refines the albedo at low rates on another random subset of the samples: in one subset of a large capture a
// texel has few samples, and the field learns their noise. result: of the same surface. About 30 s on two
// cores.
void refine_albedo(const Device&, const AppearanceInput&, const AppearanceOptions&, AppearanceResult& result,
                   Progress&, int steps = 600);

}  // namespace cei3d
