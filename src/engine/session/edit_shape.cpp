// SPDX-License-Identifier: Apache-2.0
// deform and remove: edits of the object's shape.
#include "core/base/error.h"
#include "core/base/json.h"
#include "engine/edit/deform.h"
#include "engine/edit/remove.h"
#include "engine/session/edit_ops.h"
#include "engine/session/edit_params.h"
#include "model/geometry/shape/vec_json.h"

namespace cei3d {
namespace {

DeformHandle handle_from(JsonReader& params, const Normalization& n) {
  DeformHandle h{to_float(n.unit_from_capture(vector_from(params, "from"))),
                 to_float(n.unit_from_capture(vector_from(params, "to")))};
  if (params.has("turn")) h.turn = to_float(vector_from(params, "turn") * (double(kPi) / 180));
  return h;
}

void read_geometry(JsonReader& params, DeformRequest& request) {
  const auto geometry = params.optional<std::string>("geometry", "mesh"),
             distance = params.optional<std::string>("distance", "signed");
  if (geometry != "mesh" && geometry != "field") fail_usage("unknown geometry '{}': mesh or field", geometry);
  if (distance != "signed" && distance != "l1") fail_usage("unknown distance '{}': signed or l1", distance);
  if (geometry == "field") request.geometry = DeformedGeometry::field;
  if (distance == "l1") request.options.refit.distance = SurfaceDistance::l1;
}

EditOutcome make_deform(const EditContext& context, const EditJob& job) {
  const Normalization& n = context.scene.normalization;
  JsonReader params = job.reader();
  DeformRequest request;
  request.id = job.id;
  request.handles.push_back(handle_from(params, n));
  if (params.has("more"))
    for (const Json& more : params.array("more")) {
      JsonReader reader(more, "A handle of edit " + job.id);
      request.handles.push_back(handle_from(reader, n));
      reader.finish();
    }
  if (params.has("pins"))
    for (const Json& pin : params.array("pins")) {
      const Json named = {{"pin", pin}};
      JsonReader reader(named, "A pin of edit " + job.id);
      request.pins.push_back(to_float(n.unit_from_capture(vector_from(reader, "pin"))));
    }
  read_geometry(params, request);
  settings_from(params, deform_settings(), request.options);
  if (const auto radius = params.optional<double>("radius")) request.radius = float(*radius * n.scale);
  request.part = params.optional<std::string>("part", "");
  params.finish();
  DeformResult result = deform(context.device, context.scene, request, context.progress);
  const DeformReport& r = result.report;
  Json report = {{"from", job.params.at("from")},    {"to", job.params.at("to")},
                 {"vertices", r.vertices},           {"radius", r.radius / n.scale},
                 {"farthest", r.farthest / n.scale}, {"iterations", r.iterations}};
  if (r.misfit) report["misfit"] = *r.misfit / n.scale;
  return {std::move(result.layer), std::move(report)};
}

EditOutcome make_remove(const EditContext& context, const EditJob& job) {
  JsonReader params = job.reader();
  const auto part = params.require<std::string>("part");
  params.finish();
  RemoveResult result = remove_part(context.device, context.scene, {job.id, part}, context.progress);
  const RemoveReport& r = result.report;
  return {std::move(result.layer),
          {{"removed_triangles", r.removed_triangles},
           {"added_triangles", r.added_triangles},
           {"holes", r.holes},
           {"pieces", r.pieces}}};
}

Aspects deform_depends(const Json& params) { return {.shape = true, .parts = params.contains("part")}; }
Aspects remove_depends(const Json&) {
  return {.shape = true, .look = true, .parts = true};
}  // the color of added surface depends on it

}  // namespace

const EditOp kDeformOp{"deform", 1, make_deform, deform_depends};
const EditOp kRemoveOp{"remove", 1, make_remove, remove_depends};

}  // namespace cei3d
