// SPDX-License-Identifier: Apache-2.0
#include "engine/edit/remove.h"

#include "core/base/cancel.h"
#include "core/base/clock.h"
#include "core/base/error.h"
#include "engine/edit/part_vertices.h"
#include "model/geometry/mesh/cut.h"
#include "model/scene/appearance.h"

namespace cei3d {
namespace {

void check_part(const Mesh& mesh, const std::vector<uint8_t>& inside, const std::string& part) {
  size_t some = 0, all = 0;
  for (const auto& t : mesh.triangles) {
    some += inside[t[0]] || inside[t[1]] || inside[t[2]];
    all += inside[t[0]] && inside[t[1]] && inside[t[2]];
  }
  if (some == 0)
    fail("Part '{}' holds nothing of the surface as it is now: there is nothing to remove.", part);
  if (all == mesh.triangles.size()) fail("Part '{}' is the whole object: nothing would be left.", part);
}

}  // namespace

RemoveResult remove_part(const Device& device, const Scene& scene, const RemoveRequest& request,
                         Progress& progress) {
  const double start = steady_seconds();
  const Mesh& mesh = scene.surface->mesh();
  const std::vector<uint8_t> inside = part_vertices(scene, request.part);
  check_part(mesh, inside, request.part);
  progress.report({"remove", 0.2, -1, ""});
  CutResult result = cut(mesh, inside, appearance_at(device, scene, vertex_hits(mesh)).albedo);
  check_cancelled(progress, "Removing was interrupted; nothing was changed.");
  RemoveResult out;
  out.layer.id = request.id;
  out.report.removed_triangles = result.reshape.removed.size();
  out.report.added_triangles = result.reshape.added_triangles.size();
  out.report.holes = result.report.holes;
  out.report.pieces = result.report.pieces;
  out.layer.reshape = std::make_shared<Reshape>(std::move(result.reshape));
  out.report.seconds = steady_seconds() - start;
  return out;
}

}  // namespace cei3d
