// SPDX-License-Identifier: Apache-2.0
#include "core/base/json.h"
#include "engine/edit/material.h"
#include "engine/session/edit_ops.h"
#include "engine/session/edit_params.h"

namespace cei3d {
namespace {

EditOutcome make(const EditContext& context, const EditJob& job) {
  JsonReader params = job.reader();
  const Effects effects = effects_from_params(params);
  MaterialRequest request;
  request.id = job.id;
  request.part = params.optional<std::string>("part", "");
  params.finish();
  request.change = effects.change;
  request.color = effects.color;
  request.keep_texture = !effects.replace;
  MaterialResult result = change_material(context.device, context.scene, request);
  return {std::move(result.layer), {{"points", result.report.points}}};
}

Aspects depends(const Json& params) {
  const bool part = params.contains("part"),
             mean = params.contains("color") && !params.value("replace", false);
  return {.shape = part || mean, .look = mean, .parts = part};
}

}  // namespace

// Version 2: scales, blends and presets.
const EditOp kMaterialOp{"material", 2, make, depends};

}  // namespace cei3d
