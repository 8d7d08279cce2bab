// SPDX-License-Identifier: Apache-2.0
#include <algorithm>

#include "core/base/error.h"
#include "core/compute/device.h"
#include "engine/edit/change_report.h"
#include "engine/io/capture.h"
#include "engine/io/image_file.h"
#include "engine/metrics/psnr.h"
#include "engine/project/project.h"
#include "engine/session/frame_files.h"
#include "engine/session/session.h"

namespace cei3d {
namespace {

// The view that an edit was made in, else the first one that was held out, else the first.
const View& view_to_show(const Project& project, const ChangeRequest& request) {
  const std::vector<View>& views = project.capture().views;
  std::string name = request.view;
  if (name.empty()) name = project.edit(request.id).params.value("view", "");
  name = name.substr(0, name.find(' '));  // of several views, the first
  if (!name.empty()) return find_view(project.capture(), name);
  const auto held_out =
      std::find_if(views.begin(), views.end(), [](const View& v) { return v.split == Split::test; });
  if (views.empty()) fail("The project has no views to show the edit in.");
  return held_out == views.end() ? views.front() : *held_out;
}

Image side_by_side(const Image& left, const Image& right) {
  const Image l = over_background(rounded_srgb(left), 1), r = over_background(rounded_srgb(right), 1);
  Image out(l.width + r.width, l.height, 3);
  for (int y = 0; y < l.height; ++y) {
    std::copy(l.at(0, y), l.at(0, y) + 3 * l.width, out.at(0, y));
    std::copy(r.at(0, y), r.at(0, y) + 3 * r.width, out.at(l.width, y));
  }
  return out;
}

}  // namespace

ChangeSummary Session::show_change(const ChangeRequest& request) const {
  const View& view = view_to_show(project(), request);
  const Scene before = project().scene_below(project().stack(), request.id);
  const Scene all = project().scene();
  const auto layer = std::find_if(all.layers.begin(), all.layers.end(),
                                  [&](const EditLayer& l) { return l.id == request.id; });
  if (layer == all.layers.end())
    fail_usage("There is no edit '{}' that is on; `cei3d log` lists them.", request.id);
  const Camera camera = before.normalization.unit_from_input(view.camera);
  const ChangeReport r = compare_views(*device_, before, with_layer(before, *layer), camera, request.samples);
  if (!request.picture.empty()) write_png(request.picture, side_by_side(r.before.rgb, r.after.rgb));
  return {view.name, r.pixels_inside, r.pixels_changed, r.changed_outside};
}

}  // namespace cei3d
