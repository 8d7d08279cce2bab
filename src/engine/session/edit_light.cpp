// SPDX-License-Identifier: Apache-2.0
#include "core/base/json.h"
#include "engine/io/npy.h"
#include "engine/session/edit_ops.h"
#include "engine/session/light_choice.h"
#include "model/geometry/shape/vec_json.h"

namespace cei3d {
namespace {

std::optional<Sun> sun_from(JsonReader& params) {
  if (!params.has("sun")) return std::nullopt;
  JsonReader reader = params.object("sun");
  const Sun sun{vector_from(reader, "direction"), reader.require<double>("strength")};
  reader.finish();
  return sun;
}

EditOutcome make(const EditContext& context, const EditJob& job) {
  JsonReader params = job.reader();
  SgMixture light = context.scene.light;
  if (params.optional<std::string>("env"))
    light = light_from_array(decode_npy(job.input("light.npy"), "light.npy").floats());
  EditOutcome out;
  out.layer.id = job.id;
  out.layer.everywhere = true;
  const double degrees = params.optional("rotate_degrees", 0.0), scale = params.optional("scale", 1.0);
  const std::optional<Sun> sun = sun_from(params);
  params.finish();
  light = turned_light(light, degrees, scale, context.scene.up);
  if (sun) light = with_sun(light, *sun);
  out.report = {{"lobes", light.lobes.size()}};
  out.layer.light = std::move(light);
  return out;
}

Aspects depends(const Json& params) { return {.light = !params.contains("env")}; }

}  // namespace

// Version 2: a sun.
const EditOp kLightOp{"light", 2, make, depends};

}  // namespace cei3d
