// SPDX-License-Identifier: Apache-2.0
#include <algorithm>

#include "core/base/error.h"
#include "core/base/json.h"
#include "core/base/parallel.h"
#include "core/compute/device.h"
#include "engine/capture/capture.h"
#include "engine/edit/change_report.h"
#include "engine/io/image_file.h"
#include "engine/project/project.h"
#include "engine/render/render_cache.h"
#include "engine/session/frame_files.h"
#include "engine/session/session.h"
#include "model/geometry/shape/camera_json.h"

namespace cei3d {
namespace {

// The camera of its own that an edit was made with.
std::optional<View> own_camera(const Json& params) {
  const Json& j = params.contains("strokes") ? params.at("strokes").at(0) : params;
  if (!j.contains("camera")) return std::nullopt;
  JsonReader reader(j, "The edit");
  reader.has("view");
  View view;
  JsonReader camera = reader.object("camera");
  view.name = "of the edit's own camera";
  view.camera = camera_from_json(camera);
  return view;
}

// The view that an edit was made in, else the first one that was held out, else the first.
View view_to_show(const Project& project, const ChangeRequest& request) {
  const std::vector<View>& views = project.capture().views;
  std::string name = request.view;
  const Json params = project.edit(request.id).params;
  if (name.empty()) name = params.value("view", "");
  if (const auto own = own_camera(params); own && name.empty()) return *own;
  name = name.substr(0, name.find(' '));  // of several views, the first
  if (!name.empty()) return find_view(project.capture(), name);
  const auto held_out =
      std::find_if(views.begin(), views.end(), [](const View& v) { return v.split == Split::test; });
  if (views.empty()) fail("The project has no views to show the edit in.");
  return held_out == views.end() ? views.front() : *held_out;
}

}  // namespace

ChangeSummary Session::show_change(const ChangeRequest& request) {
  return threads_->run([&]() -> ChangeSummary {
    const View view = view_to_show(project(), request);
    const Scene before = project().scene_below(project().stack(), request.id);
    const Scene all = project().scene();
    const auto layer = std::find_if(all.layers.begin(), all.layers.end(),
                                    [&](const EditLayer& l) { return l.id == request.id; });
    if (layer == all.layers.end())
      fail_usage("There is no edit '{}' that is on; `cei3d log` lists them.", request.id);
    const Camera camera = before.normalization.unit_from_capture(view.camera);
    const ChangeReport r =
        compare_views(*device_, *frames_, before, with_layer(before, *layer), camera, request.samples);
    if (!request.picture.empty())
      write_png(request.picture, side_by_side({rounded_srgb(r.before.rgb), rounded_srgb(r.after.rgb)}));
    return {view.name, r.pixels_inside, r.pixels_changed, r.changed_outside};
  });
}

}  // namespace cei3d
