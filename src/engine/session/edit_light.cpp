// SPDX-License-Identifier: Apache-2.0
#include "engine/io/npy.h"
#include "engine/session/edit_ops.h"
#include "engine/session/light_choice.h"

namespace cei3d {
namespace {

EditOutcome make(const EditContext& context, const EditJob& job) {
  SgMixture light = context.scene.light;
  if (job.params.contains("env"))
    light = light_from_array(decode_npy(job.input("light.npy"), "light.npy").floats());
  EditOutcome out;
  out.layer.id = job.id;
  out.layer.everywhere = true;
  out.layer.light = turned_light(light, job.params.value("rotate_degrees", 0.0),
                                 job.params.value("scale", 1.0), context.scene.up);
  out.report = {{"lobes", light.lobes.size()}};
  return out;
}

Aspects depends(const Json& params) { return {.light = !params.contains("env")}; }

}  // namespace

const EditOp kLightOp{"light", 1, make, depends};

}  // namespace cei3d
