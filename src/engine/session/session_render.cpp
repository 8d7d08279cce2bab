// SPDX-License-Identifier: Apache-2.0
#include <algorithm>

#include "core/base/cancel.h"
#include "core/base/error.h"
#include "core/base/file.h"
#include "core/base/json.h"
#include "core/base/parallel.h"
#include "core/compute/device.h"
#include "engine/io/image_file.h"
#include "engine/project/project.h"
#include "engine/render/render_cache.h"
#include "engine/session/cameras.h"
#include "engine/session/frame_files.h"
#include "engine/session/light_choice.h"
#include "engine/session/session.h"
#include "engine/session/stopwatch.h"
#include "engine/session/version.h"
#include "model/geometry/shape/camera_json.h"

namespace cei3d {
namespace fs = std::filesystem;
namespace {

// One scale for every view of a run: the farthest point that any of them can see becomes 65535.
double depth_scale(const std::vector<NamedCamera>& cameras, const Normalization& n) {
  double farthest = 0;
  for (const NamedCamera& c : cameras)
    farthest = std::max(farthest, length(c.camera.center - n.center) + 1 / n.scale);
  return 65535 / farthest;
}

fs::path picture_path(const fs::path& out, Channel channel, const NamedCamera& c) {
  return out / channel_name(channel) / (c.file + ".png");
}

Json light_json(const LightChoice& light) {
  constexpr const char* kNames[] = {"by the capture's up axis", "zup", "yup", "mitsuba", "blender"};
  Json j = {{"env", light.env.empty() ? Json("the object's own") : Json(light.env.string())},
            {"rotate_degrees", light.rotate_degrees}};
  if (light.sun) {
    const Vec3d d = light.sun->direction;
    j["sun"] = {{"direction", {d.x, d.y, d.z}}, {"strength", light.sun->strength}};
  }
  if (!light.env.empty()) j["convention"] = kNames[size_t(light.convention)];
  return j;
}

Json run_json(const Project& project, const RenderRequest& request, const std::vector<NamedCamera>& cameras,
              double depth, bool residual) {
  Json channels = Json::array(), list = Json::array();
  for (const Channel c : request.channels) channels.push_back(channel_name(c));
  for (const NamedCamera& c : cameras) {
    Json j = {{"name", c.name}, {"file", c.file + ".png"}};
    j.update(camera_json(c.camera));
    list.push_back(std::move(j));
  }
  return {{"program", std::string("cei3d ") + kVersion},
          {"project", fs::absolute(project.folder()).lexically_normal().string()},
          {"edits", project.stack().active()},
          {"light", light_json(request.light)},
          {"channels", std::move(channels)},
          {"switches", {{"samples_per_axis", request.samples}, {"residual", residual}}},
          {"depth",
           {{"scale", depth}, {"meaning", "z-depth in capture units = 16-bit value / scale; 0: nothing"}}},
          {"axes", "OpenCV: x right, y down, z forward; world: the capture's; pixel centers at +0.5"},
          {"cameras", std::move(list)}};
}

}  // namespace

RenderReport Session::render(const RenderRequest& request, Progress& progress) {
  return threads_->run([&]() -> RenderReport {
    Stopwatch whole, watch;
    const std::vector<NamedCamera> cameras =
        choose_cameras(project(), request.cameras, request.width, request.height);
    Scene scene = project().scene();
    scene.light =
        chosen_light(*device_, request.light, scene.light, scene.up, {project().folder() / "cache"});
    if (!request.residual || !request.light.is_own()) scene.residual = nullptr;
    const double depth = depth_scale(cameras, scene.normalization);
    // The object's own light turns with the photographs; other cameras may be anywhere.
    const bool turns = request.light.env.empty() && shows_photographs(request.cameras);
    RenderReport report;
    for (size_t i = 0; i < cameras.size(); ++i) {
      check_cancelled(progress, "Rendering was interrupted; the images written so far are complete.");
      progress.report({"render", double(i) / double(cameras.size()), -1, cameras[i].name});
      watch.lap();
      const auto view =
          frames_->trace(scene, scene.normalization.unit_from_capture(cameras[i].camera), request.samples);
      report.trace_seconds += watch.lap();
      const Scene lit = turns ? in_view(scene, cameras[i].camera) : scene;
      const Frame frame = frames_->shade(lit, frames_->light(lit), *view);
      report.shade_seconds += watch.lap();
      for (const Channel c : request.channels)
        write_png(picture_path(request.out, c, cameras[i]), channel_image(frame, c, depth), channel_bits(c));
    }
    write_file_atomic(request.out / "render.json",
                      run_json(project(), request, cameras, depth, bool(scene.residual)).dump(1) + "\n");
    progress.report({"render", 1, 0, ""});
    report.views = cameras.size();
    for (const Channel c : request.channels) report.folders.push_back(request.out / channel_name(c));
    report.seconds = whole.lap();
    return report;
  });
}

}  // namespace cei3d
