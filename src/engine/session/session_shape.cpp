// SPDX-License-Identifier: Apache-2.0
#include "core/base/error.h"
#include "core/base/json.h"
#include "core/base/parallel.h"
#include "engine/capture/capture.h"
#include "engine/capture/undistort.h"
#include "engine/edit/deform.h"
#include "engine/project/project.h"
#include "engine/render/render.h"
#include "engine/session/edit_params.h"
#include "engine/session/edit_plan.h"
#include "engine/session/session.h"
#include "model/geometry/shape/vec_json.h"

namespace cei3d {
namespace {

// The surface point at the pixel, and its target after the drag in the plane parallel to the image.
PointDrag drag_of(const Device& device, const Scene& scene, const Capture& capture, const PixelDrag& d) {
  Json where = Json::object();
  put_place(capture, d.view, d.camera, where);
  JsonReader reader(where, "The drag");
  const EditPlace view = place_from(capture, reader);
  const Camera camera = scene.normalization.unit_from_capture(view.camera);
  const Camera& photo = view.file_camera();
  if (!(d.pixel.x >= 0 && d.pixel.y >= 0 && d.pixel.x <= photo.width && d.pixel.y <= photo.height))
    fail_usage("Pixel {:.6g},{:.6g} is not in view {}, which is {}x{}.", d.pixel.x, d.pixel.y, view.name,
               photo.width, photo.height);
  const Vec2d begin = position_on_view(view, d.pixel), end = position_on_view(view, d.pixel + d.drag);
  const Ray rays[] = {camera.ray(begin.x, begin.y)};
  std::vector<uint32_t> ray_of_hit;
  const std::vector<Hit> hits = trace_rays(device, scene, rays, ray_of_hit);
  if (hits.empty())
    fail("View {} shows the background at pixel {:.6g},{:.6g}; drag from a pixel on the object.", view.name,
         d.pixel.x, d.pixel.y);
  const Vec3d from = to_double(hits[0].position);
  const Vec3d forward = to_double(camera.forward());
  const Vec3d towards = to_double(camera.ray(end.x, end.y).direction);
  const Vec3d to = camera.center + towards * (dot(from - camera.center, forward) / dot(towards, forward));
  return {scene.normalization.capture_from_unit(from), scene.normalization.capture_from_unit(to)};
}

Json handle_json(const PointDrag& drag) {
  Json j = {{"from", vector_json(drag.from)}, {"to", vector_json(drag.to)}};
  if (length(drag.turn) > 0) j["turn"] = vector_json(drag.turn);
  return j;
}

}  // namespace

EditPlan Session::plan(const DeformCommand& command) const {
  const auto* points = std::get_if<PointDrag>(&command.drag);
  const PointDrag drag =
      points ? *points
             : drag_of(*device_, project().scene(), project().capture(), std::get<PixelDrag>(command.drag));
  Json params = handle_json(drag);
  for (const PointDrag& d : command.more) params["more"].push_back(handle_json(d));
  for (const Vec3d pin : command.pins) params["pins"].push_back(vector_json(pin));
  if (command.geometry != "mesh") {
    params["geometry"] = command.geometry;
    params["distance"] = command.distance;
  }
  put_settings(deform_settings().infos(), command.set, params);
  if (command.geometry != "field") refuse_settings(params, "refit.", "it goes with geometry field");
  if (command.radius) params["radius"] = *command.radius;
  if (!command.part.empty()) params["part"] = command.part;
  return {"deform", std::move(params), {}};
}

EditPlan Session::plan(const RemoveCommand& command) const {
  return {"remove", {{"part", command.part}}, {}};
}

}  // namespace cei3d
