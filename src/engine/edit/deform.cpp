// SPDX-License-Identifier: Apache-2.0
#include "engine/edit/deform.h"

#include <algorithm>
#include <cmath>

#include "core/base/cancel.h"
#include "core/base/clock.h"
#include "core/base/error.h"
#include "core/math/rotation.h"
#include "engine/edit/part_vertices.h"
#include "model/geometry/mesh/arap.h"
#include "model/geometry/mesh/geodesic.h"
#include "model/geometry/mesh/surface_gradient.h"
#include "model/geometry/shape/carry.h"
#include "model/geometry/shape/sdf_normals.h"

namespace cei3d {
namespace {

constexpr float kDefaultRadius = 0.3f, kRadiusPerDrag = 1.5f;
constexpr float kNear = 0.05f;  // maximum distance of a given handle from the surface
// Iterations for a few seconds of work: 60 up to ten thousand vertices, fewer for larger regions, where the
// last dozens move the surface by one or two hundredths of the drag.
constexpr int kMaxIterations = 60, kMinIterations = 12, kVertexIterations = 600'000;

std::string in_capture(const Scene& scene, Vec3f p) {
  Vec3d q = scene.normalization.capture_from_unit(to_double(p));
  for (int i = 0; i < 3; ++i)
    if (abs(q[i]) < 1e-6 / scene.normalization.scale) q[i] = 0;  // rounding
  return fmt::format("{:.4g},{:.4g},{:.4g}", q.x, q.y, q.z);
}

// d rotated by an axis times an angle.
Vec3f turned(Vec3f turn, Vec3f d) {
  const float angle = length(turn);
  return angle == 0 ? d : about_axis(turn / angle, angle) * d;
}

bool is_finite(Vec3f p) { return std::isfinite(p.x) && std::isfinite(p.y) && std::isfinite(p.z); }

void check_drags(const Scene& scene, const DeformRequest& r) {
  if (r.handles.empty()) fail_usage("A deformation needs a point to drag.");
  for (const DeformHandle& h : r.handles) {
    if (!is_finite(h.from) || !is_finite(h.to) || !is_finite(h.turn))
      fail_usage("The ends of the drag must be finite numbers.");
    if (length(h.to - h.from) < 1e-5f && length(h.turn) == 0)
      fail_usage("The drag has no length: it ends where it begins.");
    if (length(h.to) > 1)
      fail(
          "The drag ends at {}, outside the sphere of radius {:.4g} around {} that the object lives in; drag "
          "less far.",
          in_capture(scene, h.to), 1 / scene.normalization.scale, in_capture(scene, {0, 0, 0}));
  }
  if (r.radius && !(*r.radius > 0)) fail_usage("The radius must be more than 0.");
}

uint32_t nearest_vertex(const Mesh& mesh, Vec3f to) {
  uint32_t best = mesh.triangles.at(0)[0];
  float smallest = length(mesh.positions[best] - to);
  for (const auto& t : mesh.triangles)
    for (const uint32_t v : t) {
      const float d = length(mesh.positions[v] - to);
      if (d < smallest || (d == smallest && v < best)) best = v, smallest = d;
    }
  return best;
}

// what: "Drag from" or "Pin".
uint32_t vertex_at(const Scene& scene, Vec3f given, const char* what) {
  const Mesh& mesh = scene.surface->mesh();
  const uint32_t vertex = nearest_vertex(mesh, given);
  const Vec3f p = mesh.positions[vertex];
  if (!is_finite(given) || length(p - given) > kNear)
    fail("There is no surface at {}; the nearest is at {}, {:.3g} away. {} a point of the surface.",
         in_capture(scene, given), in_capture(scene, p), length(p - given) / scene.normalization.scale, what);
  return vertex;
}

uint32_t find_handle(const Scene& scene, const DeformRequest& r, Vec3f from,
                     const std::vector<uint8_t>& on_part) {
  const uint32_t handle = vertex_at(scene, from, "Drag from");
  if (!on_part.empty() && !on_part[handle])
    fail("The point {} is not on part '{}'; drag from a point of the part.", in_capture(scene, from), r.part);
  return handle;
}

struct Reach {
  ArapConstraints constraints;
  float radius = 0;
};

// Distances along the surface from a vertex; infinite beyond the limits.
std::vector<float> distances_from(const Mesh& mesh, const std::vector<uint8_t>& on_part, uint32_t vertex,
                                  float farthest) {
  GeodesicLimits limits;
  limits.farthest = farthest;
  if (!on_part.empty()) limits.may_enter = [&](uint32_t v) { return on_part[v] != 0; };
  return geodesic_distances(mesh.positions, mesh.triangles, vertex, limits);
}

// Maximum distance from a handle that moves; infinite: the whole part.
float farthest_of(const DeformRequest& r, bool has_part) {
  if (r.radius) return *r.radius;
  if (has_part) return GeodesicLimits().farthest;
  float longest = 0;
  for (const DeformHandle& h : r.handles) longest = max(longest, length(h.to - h.from));
  return max(kDefaultRadius, kRadiusPerDrag * longest);
}

// Constraints: a disc around each handle moves with its drag, discs around pins stay, the rest of the radius
// or of the part is free.
Reach reach_of(const Scene& scene, const DeformRequest& r, const std::vector<uint8_t>& on_part) {
  const Mesh& mesh = scene.surface->mesh();
  const size_t n = mesh.positions.size();
  const float farthest = farthest_of(r, !on_part.empty());
  Reach reach;
  std::vector<std::vector<float>> distances;
  for (const DeformHandle& h : r.handles) {
    distances.push_back(distances_from(mesh, on_part, find_handle(scene, r, h.from, on_part), farthest));
    for (const float d : distances.back())
      if (!std::isinf(d)) reach.radius = max(reach.radius, d);
  }
  if (!std::isinf(farthest)) reach.radius = farthest;
  const float disc = r.options.handle_share * reach.radius;
  reach.constraints.free.assign(n, 0);
  std::vector<uint8_t> held(n, 0);
  for (size_t k = 0; k < r.handles.size(); ++k)
    for (uint32_t v = 0; v < n; ++v) {
      if (std::isinf(distances[k][v]) || held[v]) continue;
      reach.constraints.free[v] = 1;
      if (distances[k][v] > disc) continue;
      held[v] = 1;
      const DeformHandle& h = r.handles[k];
      reach.constraints.handles.push_back(v);
      reach.constraints.targets.push_back(h.to + turned(h.turn, mesh.positions[v] - h.from));
    }
  for (const Vec3f pin : r.pins) {
    const std::vector<float> d = distances_from(mesh, {}, vertex_at(scene, pin, "Pin"), disc);
    for (uint32_t v = 0; v < n; ++v)
      if (!std::isinf(d[v])) reach.constraints.free[v] = 0;
  }
  for (const uint32_t v : reach.constraints.handles) reach.constraints.free[v] = 0;
  return reach;
}

ArapOptions arap_options(const Reach& reach, const DeformOptions& o) {
  ArapOptions options;
  options.bending_length = o.handle_share * reach.radius;
  const int free = int(std::count(reach.constraints.free.begin(), reach.constraints.free.end(), 1));
  options.max_iterations =
      o.iterations > 0 ? o.iterations
                       : std::clamp(kVertexIterations / std::max(free, 1), kMinIterations, kMaxIterations);
  return options;
}

SettingTable<DeformOptions> make_settings() {
  SettingTable<DeformOptions> table;
  const SettingGroup<DeformOptions, DeformOptions> deform(
      table, "", [](DeformOptions& o) -> DeformOptions& { return o; });
  deform
      .add("handle_share", &DeformOptions::handle_share, {0.01, 0.9}, "of the radius",
           "Surface that moves rigidly with the handle, and over which bending is resisted")
      .add("iterations", &DeformOptions::iterations, {0, 10'000}, "iterations",
           "Maximum number of rounds of the deformation; 0: as many as a few seconds allow",
           "[Sorkine and Alexa 2007]");
  deform.part("refit.", &DeformOptions::refit)
      .add("steps", &RefitOptions::steps, {1, 1e6}, "steps", "Training steps of the field",
           "[paper sec. 5.1]")
      .add("batch", &RefitOptions::batch, {4, 1e6, 4}, "points a step", "Size of a training batch")
      .add("table_rate", &RefitOptions::table_rate, {0, 1}, "", "Learning rate of the hash tables",
           "[Kingma and Ba 2015]")
      .add("layer_rate", &RefitOptions::layer_rate, {0, 1}, "",
           "Learning rate of the layers of a field without hash tables", "[paper sec. 5.1]");
  return table;
}

void check_reach(const Scene& scene, const DeformRequest& r, const Reach& reach) {
  std::vector<uint8_t> moves = reach.constraints.free;
  for (const uint32_t v : reach.constraints.handles) moves[v] = 1;
  const auto& triangles = scene.surface->mesh().triangles;
  const auto moves_all = [&](const auto& t) { return moves[t[0]] && moves[t[1]] && moves[t[2]]; };
  if (std::all_of(triangles.begin(), triangles.end(), moves_all))
    fail("The whole object would move; give a smaller radius, or the part that should.");
  if (std::none_of(triangles.begin(), triangles.end(), moves_all))
    fail("Not one triangle of the surface is within {:.3g} of {}; give a larger {}.",
         reach.radius / scene.normalization.scale, in_capture(scene, r.handles[0].from),
         r.part.empty() ? "radius" : "part");
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

// The points of the deformed surface, for its field: handler points, and the vertices of the mesh, which are
// also where no view has seen it.
DeformedPoints deformed_points(const Scene& scene, const Reshape& change) {
  const Mesh &before = scene.surface->mesh(), after = apply(before, change);
  DeformedPoints out;
  std::vector<uint8_t> moved(before.positions.size(), 0), used(moved);
  for (const uint32_t v : change.moved) moved[v] = 1;
  for (const auto& t : before.triangles)
    for (const uint32_t v : t) used[v] = 1;
  for (size_t v = 0; v < before.positions.size(); ++v) {
    if (!used[v]) continue;
    if (moved[v]) out.vacated.push_back(before.positions[v]);
    out.points.positions.push_back(after.positions[v]);
    out.points.normals.push_back(after.normals[v]);
    out.moved.push_back(moved[v]);
  }
  double edges = 0;
  for (const auto& t : before.triangles) edges += length(before.positions[t[1]] - before.positions[t[0]]);
  out.points.spacing = max(1e-4f, float(edges / double(std::max<size_t>(before.triangles.size(), 1))));
  if (scene.handlers) {
    const HandlerPoints& were = *scene.handlers;
    const HandlerPoints now = carried(were, before, after, change);
    for (size_t i = 0; i < now.positions.size(); ++i) {
      const Vec3f step = now.positions[i] - were.positions[i];
      out.points.positions.push_back(now.positions[i]);
      out.points.normals.push_back(now.normals[i]);
      out.moved.push_back(dot(step, step) > 0);
    }
  }
  out.points.footprints.assign(out.points.positions.size(), out.points.spacing);
  return out;
}

// The field that the edit starts from: that of the last version that has one.
const Field& present_field(const Scene& scene) {
  for (auto v = scene.shape_versions.rbegin(); v != scene.shape_versions.rend(); ++v)
    if ((*v)->sdf) return *(*v)->sdf;
  return *scene.sdf;
}

// How far the zero set of a field is from a surface, on average; infinite where the field has no inside.
float misfit_of(const Device& device, const Field& sdf, const Reshape& surface,
                const std::vector<Vec3f>& on_zero_set) {
  constexpr float kBelow = 0.01f, kMinInside = 0.5f;  // thin parts end above that depth
  const std::vector<float> values = first_output(device, sdf, on_zero_set);
  std::vector<Vec3f> below;
  double sum = 0;
  for (size_t i = 0; i < values.size(); ++i) {
    sum += max(length(on_zero_set[i] - surface.positions[i]), std::abs(values[i])) / double(values.size());
    below.push_back(surface.positions[i] - surface.normals[i] * kBelow);
  }
  const std::vector<float> depths = first_output(device, sdf, below);
  const auto inside = std::count_if(depths.begin(), depths.end(), [](float d) { return d < 0; });
  return float(inside) < kMinInside * float(depths.size()) ? INFINITY : float(sum);
}

// Gives the moved surface a field of its own, and takes the change of shape to the zero set of it. Returns
// the mean distance between both.
float refit(const Device& device, const Scene& scene, const DeformRequest& request, Reshape& change,
            std::shared_ptr<const Field>& sdf, const Progress& progress) {
  constexpr float kMaxMisfit = 0.01f;
  if (!scene.sdf) fail("The object has no distance field to deform; deform the mesh instead.");
  sdf = std::make_shared<const Field>(refit_field(
      device, present_field(scene), deformed_points(scene, change), request.options.refit, progress));
  const std::vector<Vec3f> fitted = on_zero_set(device, *sdf, change.positions);
  const float misfit = misfit_of(device, *sdf, change, fitted);
  if (std::isinf(misfit))
    fail("The field has lost its inside{}.", request.options.refit.distance == SurfaceDistance::l1
                                                 ? ", as unsigned distances have none; use signed ones"
                                                 : "; deform the mesh instead");
  if (!(misfit < kMaxMisfit))
    fail(
        "The field did not take the new shape: its surface is {:.3g} away on average. Drag less far, or "
        "deform the mesh instead.",
        misfit / scene.normalization.scale);
  std::vector<Vec3f> after = scene.surface->mesh().positions;
  for (size_t i = 0; i < fitted.size(); ++i) after[change.moved[i]] = fitted[i];
  change = reshape_to(scene, after);
  sdf_normals(device, *sdf, change.positions, change.normals);
  return misfit;
}

}  // namespace

const SettingTable<DeformOptions>& deform_settings() {
  static const SettingTable<DeformOptions> table = make_settings();
  return table;
}

DeformResult deform(const Device& device, const Scene& scene, const DeformRequest& request,
                    Progress& progress) {
  const double start = steady_seconds();
  check_drags(scene, request);
  const std::vector<uint8_t> on_part =
      request.part.empty() ? std::vector<uint8_t>() : part_vertices(scene, request.part);
  const Mesh& mesh = scene.surface->mesh();
  const Reach reach = reach_of(scene, request, on_part);
  check_reach(scene, request, reach);
  progress.report({"deform", 0.1, -1, ""});
  const ArapResult moved =
      arap_deform(mesh.positions, mesh.triangles, reach.constraints, arap_options(reach, request.options));
  progress.report({"deform", request.geometry == DeformedGeometry::field ? 0.2 : 0.8, -1, ""});
  check_cancelled(progress, "Deforming was interrupted; nothing was changed.");
  auto reshape = std::make_shared<Reshape>(reshape_to(scene, moved.positions));

  DeformResult result;
  result.layer.id = request.id;
  DeformReport& report = result.report;
  if (request.geometry == DeformedGeometry::field)
    report.misfit = refit(device, scene, request, *reshape, result.layer.sdf, progress);
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
