// SPDX-License-Identifier: Apache-2.0
#include "core/base/json.h"
#include "engine/io/npy.h"
#include "engine/session/edit_ops.h"
#include "engine/session/light_choice.h"

namespace cei3d {
namespace {

EditOutcome make(const EditContext& context, const EditJob& job) {
  JsonReader params = job.reader();
  SgMixture light = context.scene.light;
  if (params.optional<std::string>("env"))
    light = light_from_array(decode_npy(job.input("light.npy"), "light.npy").floats());
  EditOutcome out;
  out.layer.id = job.id;
  out.layer.everywhere = true;
  const double degrees = params.optional("rotate_degrees", 0.0), scale = params.optional("scale", 1.0);
  params.finish();
  out.layer.light = turned_light(light, degrees, scale, context.scene.up);
  out.report = {{"lobes", light.lobes.size()}};
  return out;
}

Aspects depends(const Json& params) { return {.light = !params.contains("env")}; }

}  // namespace

const EditOp kLightOp{"light", 1, make, depends};

}  // namespace cei3d
