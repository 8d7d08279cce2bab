// SPDX-License-Identifier: Apache-2.0
#include <chrono>

#include "core/base/error.h"
#include "engine/edit/deform.h"
#include "engine/edit/remove.h"
#include "engine/io/capture.h"
#include "engine/project/project.h"
#include "engine/render/render.h"
#include "engine/session/session.h"

namespace cei3d {
namespace {

class Stopwatch {
 public:
  double lap() {  // seconds since the last one
    const auto now = Clock::now();
    const double s = std::chrono::duration<double>(now - last_).count();
    last_ = now;
    return s;
  }

 private:
  using Clock = std::chrono::steady_clock;
  Clock::time_point last_ = Clock::now();
};

// The point that the view shows at the pixel, and where the drag takes it in the plane parallel to the
// picture.
PointDrag drag_of(const Device& device, const Scene& scene, const Capture& capture, const PixelDrag& d) {
  const View& view = find_view(capture, d.view);
  const Camera camera = scene.normalization.unit_from_input(view.camera);
  if (!(d.pixel.x >= 0 && d.pixel.y >= 0 && d.pixel.x <= camera.width && d.pixel.y <= camera.height))
    fail_usage("Pixel {:.6g},{:.6g} is not in view {}, which is {}x{}.", d.pixel.x, d.pixel.y, view.name,
               camera.width, camera.height);
  const Ray rays[] = {camera.ray(d.pixel.x, d.pixel.y)};
  std::vector<uint32_t> ray_of_hit;
  const std::vector<Hit> hits = trace_rays(device, scene, rays, ray_of_hit);
  if (hits.empty())
    fail("View {} shows the background at pixel {:.6g},{:.6g}; drag from a pixel on the object.", view.name,
         d.pixel.x, d.pixel.y);
  const Vec3d from = to_double(hits[0].position);
  const Vec3d forward = to_double(camera.forward());
  const Vec3d towards = to_double(camera.ray(d.pixel.x + d.drag.x, d.pixel.y + d.drag.y).direction);
  const Vec3d to = camera.center + towards * (dot(from - camera.center, forward) / dot(towards, forward));
  return {scene.normalization.input_from_unit(from), scene.normalization.input_from_unit(to)};
}

Json list_of(Vec3d v) { return Json::array({v.x, v.y, v.z}); }

Json params_of(const DeformCommand& command, const PointDrag& drag) {
  Json params = {{"from", list_of(drag.from)}, {"to", list_of(drag.to)}};
  if (command.radius) params["radius"] = *command.radius;
  if (!command.part.empty()) params["part"] = command.part;
  return params;
}

}  // namespace

DeformSummary Session::deform(const DeformCommand& command, Progress& progress) {
  Stopwatch watch;
  const Scene scene = project().scene();
  const auto* points = std::get_if<PointDrag>(&command.drag);
  const PointDrag drag =
      points ? *points : drag_of(*device_, scene, project().capture(), std::get<PixelDrag>(command.drag));
  DeformRequest request;
  request.id = project().stack().next_id("deform");
  request.from = to_float(scene.normalization.unit_from_input(drag.from));
  request.to = to_float(scene.normalization.unit_from_input(drag.to));
  if (command.radius) request.radius = float(*command.radius * scene.normalization.scale);
  request.part = command.part;

  DeformSummary s;
  s.id = request.id;
  s.from = drag.from;
  s.to = drag.to;
  s.load_seconds = watch.lap();
  const DeformResult result = cei3d::deform(scene, request, progress);
  s.deform_seconds = watch.lap();
  s.vertices = result.report.vertices;
  s.radius = result.report.radius / scene.normalization.scale;
  s.farthest = result.report.farthest / scene.normalization.scale;
  s.iterations = result.report.iterations;

  EditRecord record;
  record.id = request.id;
  record.op = "deform";
  record.params = params_of(command, drag);
  record.report = s.json();
  project().add_edit(record, result.layer);
  s.store_seconds = watch.lap();
  return s;
}

RemoveSummary Session::remove(const RemoveCommand& command, Progress& progress) {
  Stopwatch watch;
  const Scene scene = project().scene();
  const RemoveRequest request{project().stack().next_id("remove"), command.part};
  RemoveSummary s;
  s.id = request.id;
  s.load_seconds = watch.lap();
  const RemoveResult result = remove_part(*device_, scene, request, progress);
  s.cut_seconds = watch.lap();
  s.removed_triangles = result.report.removed_triangles;
  s.added_triangles = result.report.added_triangles;
  s.holes = result.report.holes;
  s.pieces = result.report.pieces;

  EditRecord record;
  record.id = request.id;
  record.op = "remove";
  record.params = {{"part", command.part}};
  record.report = s.json();
  project().add_edit(record, result.layer);
  s.store_seconds = watch.lap();
  return s;
}

}  // namespace cei3d
