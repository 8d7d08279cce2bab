// SPDX-License-Identifier: Apache-2.0
// deform and remove: edits of the object's shape.
#include "core/base/error.h"
#include "engine/edit/deform.h"
#include "engine/edit/remove.h"
#include "engine/session/edit_ops.h"

namespace cei3d {
namespace {

Vec3d point_from(JsonReader& params, const char* key) {
  const auto [x, y, z] = params.numbers<3>(key);
  return {x, y, z};
}

EditOutcome make_deform(const EditContext& context, const EditJob& job) {
  const Normalization& n = context.scene.normalization;
  JsonReader params = job.reader();
  DeformRequest request;
  request.id = job.id;
  request.from = to_float(n.unit_from_capture(point_from(params, "from")));
  request.to = to_float(n.unit_from_capture(point_from(params, "to")));
  if (const auto radius = params.optional<double>("radius")) request.radius = float(*radius * n.scale);
  request.part = params.optional<std::string>("part", "");
  params.finish();
  DeformResult result = deform(context.scene, request, context.progress);
  const DeformReport& r = result.report;
  return {std::move(result.layer),
          {{"from", job.params.at("from")},
           {"to", job.params.at("to")},
           {"vertices", r.vertices},
           {"radius", r.radius / n.scale},
           {"farthest", r.farthest / n.scale},
           {"iterations", r.iterations}}};
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
