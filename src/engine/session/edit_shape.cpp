// SPDX-License-Identifier: Apache-2.0
// deform and remove: edits of the object's shape.
#include "core/base/error.h"
#include "engine/edit/deform.h"
#include "engine/edit/remove.h"
#include "engine/session/edit_ops.h"

namespace cei3d {
namespace {

Vec3d point_from(const Json& j) {
  return {j.at(0).get<double>(), j.at(1).get<double>(), j.at(2).get<double>()};
}

EditOutcome make_deform(const EditContext& context, const EditJob& job) {
  const Normalization& n = context.scene.normalization;
  DeformRequest request;
  request.id = job.id;
  request.from = to_float(n.unit_from_input(point_from(job.params.at("from"))));
  request.to = to_float(n.unit_from_input(point_from(job.params.at("to"))));
  if (job.params.contains("radius")) request.radius = float(job.params.at("radius").get<double>() * n.scale);
  request.part = job.params.value("part", "");
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
  RemoveResult result = remove_part(context.device, context.scene,
                                    {job.id, job.params.at("part").get<std::string>()}, context.progress);
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
}  // new matter is coloured

}  // namespace

const EditOp kDeformOp{"deform", 1, make_deform, deform_depends};
const EditOp kRemoveOp{"remove", 1, make_remove, remove_depends};

}  // namespace cei3d
