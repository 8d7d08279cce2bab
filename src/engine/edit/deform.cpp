// SPDX-License-Identifier: Apache-2.0
#include "engine/edit/deform.h"

#include <algorithm>
#include <cmath>

#include "core/base/cancel.h"
#include "core/base/clock.h"
#include "core/base/error.h"
#include "engine/edit/part_vertices.h"
#include "model/geometry/mesh/arap.h"
#include "model/geometry/mesh/geodesic.h"
#include "model/geometry/mesh/surface_gradient.h"

namespace cei3d {
namespace {

constexpr float kDefaultRadius = 0.3f, kRadiusPerDrag = 1.5f;
constexpr float kNear = 0.05f;  // maximum distance of a given handle from the surface
// Share of the radius that moves rigidly with the handle, and over which bending is resisted. Dragging a
// single vertex makes a spike; with about a sixth, most of the radius remains for the fall-off. (On the ear
// of spot shares of 0, 0.15, 0.25 differ from an artist's smooth fall-off by 0.10, 0.06, 0.09 of the drag.)
constexpr float kHandleShare = 0.15f;
// Iterations for a few seconds of work: 60 up to ten thousand vertices, fewer for larger regions, where the
// last dozens move the surface by one or two hundredths of the drag.
constexpr int kMaxIterations = 60, kMinIterations = 12, kVertexIterations = 600'000;

std::string in_capture(const Scene& scene, Vec3f p) {
  Vec3d q = scene.normalization.capture_from_unit(to_double(p));
  for (int i = 0; i < 3; ++i)
    if (abs(q[i]) < 1e-6 / scene.normalization.scale) q[i] = 0;  // rounding
  return fmt::format("{:.4g},{:.4g},{:.4g}", q.x, q.y, q.z);
}

bool is_finite(Vec3f p) { return std::isfinite(p.x) && std::isfinite(p.y) && std::isfinite(p.z); }

void check_drag(const Scene& scene, const DeformRequest& r) {
  if (!is_finite(r.from) || !is_finite(r.to)) fail_usage("The ends of the drag must be finite numbers.");
  if (length(r.to - r.from) < 1e-5f)
    fail_usage("The drag has no length: --from and --to are the same point.");
  if (r.radius && !(*r.radius > 0)) fail_usage("--radius must be more than 0.");
  if (length(r.to) > 1)
    fail(
        "The drag ends at {}, outside the sphere of radius {:.4g} around {} that the object lives in; drag "
        "less far.",
        in_capture(scene, r.to), 1 / scene.normalization.scale, in_capture(scene, {0, 0, 0}));
}

uint32_t nearest_vertex(const Mesh& mesh, Vec3f to) {
  uint32_t best = mesh.triangles.at(0)[0];
  float least = length(mesh.positions[best] - to);
  for (const auto& t : mesh.triangles)
    for (const uint32_t v : t) {
      const float d = length(mesh.positions[v] - to);
      if (d < least || (d == least && v < best)) best = v, least = d;
    }
  return best;
}

uint32_t find_handle(const Scene& scene, const DeformRequest& r, const std::vector<uint8_t>& on_part) {
  const Mesh& mesh = scene.surface->mesh();
  const uint32_t handle = nearest_vertex(mesh, r.from);
  const Vec3f p = mesh.positions[handle];
  if (length(p - r.from) > kNear)
    fail("There is no surface at {}; the nearest is at {}, {:.3g} away. Drag from a point of the surface.",
         in_capture(scene, r.from), in_capture(scene, p), length(p - r.from) / scene.normalization.scale);
  if (!on_part.empty() && !on_part[handle])
    fail("The point {} is not on part '{}'; drag from a point of the part.", in_capture(scene, r.from),
         r.part);
  return handle;
}

struct Reach {
  ArapConstraints constraints;
  float radius = 0;
};

// Constraints: the disc around the handle moves with the drag, the rest of the radius or the part is free.
Reach reach_of(const Mesh& mesh, const DeformRequest& r, const std::vector<uint8_t>& on_part,
               uint32_t handle) {
  GeodesicLimits limits;
  if (r.radius)
    limits.farthest = *r.radius;
  else if (on_part.empty())
    limits.farthest = max(kDefaultRadius, kRadiusPerDrag * length(r.to - r.from));
  if (!on_part.empty()) limits.may_enter = [&](uint32_t v) { return on_part[v] != 0; };
  const std::vector<float> distance = geodesic_distances(mesh.positions, mesh.triangles, handle, limits);
  Reach reach;
  reach.radius = limits.farthest;
  if (std::isinf(reach.radius)) {
    reach.radius = 0;
    for (const float d : distance)
      if (!std::isinf(d)) reach.radius = max(reach.radius, d);
  }
  reach.constraints.free.assign(distance.size(), 0);
  for (uint32_t v = 0; v < distance.size(); ++v) {
    if (std::isinf(distance[v])) continue;
    if (distance[v] > kHandleShare * reach.radius) {
      reach.constraints.free[v] = 1;
    } else {
      reach.constraints.handles.push_back(v);
      reach.constraints.targets.push_back(mesh.positions[v] + (r.to - r.from));
    }
  }
  return reach;
}

void check_reach(const Scene& scene, const DeformRequest& r, const Reach& reach) {
  std::vector<uint8_t> moves = reach.constraints.free;
  for (const uint32_t v : reach.constraints.handles) moves[v] = 1;
  const auto& triangles = scene.surface->mesh().triangles;
  const auto moves_all = [&](const auto& t) { return moves[t[0]] && moves[t[1]] && moves[t[2]]; };
  if (std::all_of(triangles.begin(), triangles.end(), moves_all))
    fail("The whole object would move; give a smaller --radius, or the --part that should.");
  if (std::none_of(triangles.begin(), triangles.end(), moves_all))
    fail("Not one triangle of the surface is within {:.3g} of {}; give a larger {}.",
         reach.radius / scene.normalization.scale, in_capture(scene, r.from),
         r.part.empty() ? "--radius" : "part");
}

Reshape reshape_to(const Scene& scene, const std::vector<Vec3f>& after) {
  const Mesh& mesh = scene.surface->mesh();
  Reshape reshape;
  for (uint32_t v = 0; v < after.size(); ++v) {
    const Vec3f step = after[v] - mesh.positions[v];
    if (dot(step, step) == 0) continue;
    if (!(length(after[v]) <= 1))
      fail(
          "The drag takes the surface to {}, outside the sphere of radius {:.4g} around {} that the object "
          "lives in; drag less far.",
          in_capture(scene, after[v]), 1 / scene.normalization.scale, in_capture(scene, {0, 0, 0}));
    reshape.moved.push_back(v);
    reshape.positions.push_back(after[v]);
  }
  SurfaceGradient g = surface_gradient(mesh.positions, mesh.normals, after, mesh.triangles, reshape.moved);
  reshape.normals = std::move(g.normals);
  reshape.gradients = std::move(g.gradients);
  return reshape;
}

}  // namespace

DeformResult deform(const Scene& scene, const DeformRequest& request, Progress& progress) {
  const double start = steady_seconds();
  check_drag(scene, request);
  const std::vector<uint8_t> on_part =
      request.part.empty() ? std::vector<uint8_t>() : part_vertices(scene, request.part);
  const uint32_t handle = find_handle(scene, request, on_part);
  const Mesh& mesh = scene.surface->mesh();
  const Reach reach = reach_of(mesh, request, on_part, handle);
  check_reach(scene, request, reach);
  progress.report({"deform", 0.1, -1, ""});
  ArapOptions options;
  options.bending_length = kHandleShare * reach.radius;
  const int free = int(std::count(reach.constraints.free.begin(), reach.constraints.free.end(), 1));
  options.max_iterations = std::clamp(kVertexIterations / std::max(free, 1), kMinIterations, kMaxIterations);
  const ArapResult moved = arap_deform(mesh.positions, mesh.triangles, reach.constraints, options);
  progress.report({"deform", 0.8, -1, ""});
  check_cancelled(progress, "deforming was interrupted; nothing was changed");
  auto reshape = std::make_shared<Reshape>(reshape_to(scene, moved.positions));

  DeformResult result;
  result.layer.id = request.id;
  DeformReport& report = result.report;
  report.vertices = reshape->moved.size();
  for (size_t i = 0; i < reshape->moved.size(); ++i)
    report.farthest = max(report.farthest, length(reshape->positions[i] - mesh.positions[reshape->moved[i]]));
  report.radius = reach.radius;
  report.iterations = int(moved.energies.size());
  result.layer.reshape = std::move(reshape);
  report.seconds = steady_seconds() - start;
  return result;
}

}  // namespace cei3d
