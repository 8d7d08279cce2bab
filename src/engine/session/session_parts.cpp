// SPDX-License-Identifier: Apache-2.0
// Parts: making them, listing them, their masks in views.
#include <algorithm>
#include <chrono>

#include "core/base/cancel.h"
#include "core/base/error.h"
#include "core/base/file.h"
#include "core/base/json.h"
#include "core/base/parallel.h"
#include "core/compute/device.h"
#include "engine/capture/undistort.h"
#include "engine/edit/part.h"
#include "engine/io/image_file.h"
#include "engine/project/project.h"
#include "engine/render/render.h"
#include "engine/session/cameras.h"
#include "engine/session/edit_params.h"
#include "engine/session/edit_plan.h"
#include "engine/session/part_mask.h"
#include "engine/session/session.h"
#include "engine/session/stopwatch.h"
#include "model/scene/appearance.h"
#include "model/scene/parts.h"

namespace cei3d {
namespace {

// Clicks on the photograph, as positions on the view.
Json pixels_json(const View& view, const std::vector<Vec2d>& clicks) {
  Json list = Json::array();
  for (const Vec2d click : clicks) {
    const Vec2d p = position_on_view(view, click);
    list.push_back({p.x, p.y});
  }
  return list;
}

std::string unused_name(const Scene& scene) {
  const std::vector<std::string> names = part_names(scene);
  for (int i = 1;; ++i) {
    const std::string name = fmt::format("part{}", i);
    if (std::find(names.begin(), names.end(), name) == names.end()) return name;
  }
}

void put_combination(const PartCommand& c, Json& params) {
  const std::pair<const char*, const std::string*> all[] = {
      {"add", &c.add}, {"subtract", &c.subtract}, {"intersect", &c.intersect}};
  for (const auto& [key, part] : all)
    if (!part->empty()) params[key] = *part;
}

// Usage errors: not exactly one way to say where the part is.
void check_place(const PartCommand& c) {
  const bool prompts = !c.positive.empty() || !c.negative.empty() || !c.scribble.empty();
  if (prompts + !c.mask.empty() + c.like.has_value() != 1)
    fail_usage(
        "Say where the part is in one way: a scribble, positive (and negative) clicks, a pixel of the same "
        "material (like) or a mask.");
  if (c.segmenter == "sam" && c.like) fail_usage("The network needs prompts; leave it out with 'like'.");
  if (c.like_color && !c.like) fail_usage("'like color' goes with 'like'.");
  if (!c.scribble.empty()) return;
  if (!c.negative_scribble.empty()) fail_usage("'negative scribble' goes with 'scribble'.");
  if (!c.negative_color.empty()) fail_usage("'negative color' goes with 'scribble'.");
  if (c.keep_color) fail_usage("'keep color' goes with 'scribble'.");
  if (c.keep_texture) fail_usage("'keep texture' goes with 'color' or 'scribble'.");
}

void put_scribble(const PartCommand& c, Json& params, EditInputs& inputs) {
  if (c.scribble.empty()) return;
  params["scribble"] = c.scribble.string();
  inputs.emplace_back("scribble.png", read_file(c.scribble));
  if (!c.negative_scribble.empty()) {
    params["negative_scribble"] = c.negative_scribble.string();
    inputs.emplace_back("negative.png", read_file(c.negative_scribble));
  }
  if (!c.negative_color.empty()) {
    color_from_text(c.negative_color);
    params["negative_color"] = c.negative_color;
  }
  if (c.keep_color) params["keep_color"] = true;
  if (c.keep_texture) params["keep_texture"] = true;
}

// Only what differs from the defaults. Usage error: no view.
void put_network(const NetworkViews& n, Json& params) {
  const ViewPlan plan = n.plan, usual;
  if (plan.max_views < 1)
    fail_usage("The network needs at least one view; give a number of views, or `all`.");
  if (n.photographs) params["on"] = "photographs";
  if (plan.max_views == ViewPlan::kAll)
    params["views"] = "all";
  else if (plan.max_views != usual.max_views)
    params["views"] = std::to_string(plan.max_views);
  if (plan.order == ViewOrder::adjacent) params["order"] = "adjacent";
  if (plan.combination == MaskCombination::any) params["combine"] = "any";
}

}  // namespace

EditPlan Session::plan(const PartCommand& command) const {
  check_place(command);
  Json params = Json::object();
  put_place(project().capture(), command.view, command.camera, params);
  params["segmenter"] = command.segmenter;
  JsonReader where(params, "The part");
  const EditPlace view = place_from(project().capture(), where);
  if (command.in_view) params["in_view"] = true;
  put_combination(command, params);
  std::string name = command.name;
  for (const std::string& other : {command.add, command.subtract, command.intersect})
    if (name.empty()) name = other;
  params["name"] = name.empty() ? unused_name(project().scene()) : name;
  if (!command.positive.empty()) params["positive"] = pixels_json(view, command.positive);
  if (!command.negative.empty()) params["negative"] = pixels_json(view, command.negative);
  if (command.like) params["like"] = pixels_json(view, {*command.like})[0];
  if (command.like_color) params["like_color"] = true;
  EditInputs inputs;
  if (!command.mask.empty()) {
    params["mask"] = command.mask.path.string();
    inputs.emplace_back("mask.png", command.mask.read());
  }
  put_scribble(command, params, inputs);
  if (command.segmenter == "sam") put_network(command.network, params);
  put_settings(part_settings().infos(), command.set, params);
  if (command.like) refuse_settings(params, "graph.", "surface of the same material is not grown");
  if (!command.like) refuse_settings(params, "like.", "it goes with 'like'");
  put_effects(command.effects, params);
  return {"part", std::move(params), std::move(inputs)};
}

std::vector<PartInfo> Session::parts() const {
  return threads_->run([&]() -> std::vector<PartInfo> {
    const Scene scene = project().scene();
    const std::vector<Hit> hits = vertex_hits(scene.surface->mesh());
    std::vector<PartInfo> list;
    for (const std::string& name : part_names(scene)) {
      const EditLayer& layer = part_layer(scene, name);
      PartInfo info{name, layer.id, 0, 0};
      for (const uint8_t i : inside_layer(scene, layer, hits)) info.points += i;
      info.share = double(info.points) / double(std::max<size_t>(hits.size(), 1));
      list.push_back(info);
    }
    return list;
  });
}

PartMasksReport Session::part_masks(const PartMasksRequest& request, Progress& progress) const {
  return threads_->run([&]() -> PartMasksReport {
    Stopwatch watch;
    const Scene scene = project().scene();
    const EditLayer& part = part_layer(scene, request.part);
    const std::vector<NamedCamera> cameras = choose_cameras(project(), request.cameras, 0, 0);
    PartMasksReport report;
    for (const NamedCamera& c : cameras) {
      check_cancelled(progress, "Writing masks was interrupted; those written so far are complete.");
      progress.report({"masks", double(report.views) / double(cameras.size()), -1, c.name});
      const GBuffer g =
          trace_view(*device_, scene, scene.normalization.unit_from_capture(c.camera), request.samples);
      const Image mask = part_mask(scene, part, g);
      write_png(request.out / (c.file + ".png"), mask);
      ++report.views;
      report.shown += std::any_of(mask.data.begin(), mask.data.end(), [](float m) { return m > 0; });
    }
    progress.report({"masks", 1, 0, ""});
    report.seconds = watch.lap();
    return report;
  });
}

}  // namespace cei3d
