// SPDX-License-Identifier: Apache-2.0
#include <optional>

#include "core/base/error.h"
#include "core/base/json.h"
#include "engine/capture/capture.h"
#include "engine/capture/undistort.h"
#include "engine/edit/paint.h"
#include "engine/edit/stroke.h"
#include "engine/io/image_file.h"
#include "engine/io/png_file.h"
#include "engine/render/render_cache.h"
#include "engine/session/edit_ops.h"
#include "engine/session/edit_params.h"
#include "engine/session/requests.h"

namespace cei3d {
namespace {

// sRGB as stored.
Image decode_scribble(const std::string& bytes, const std::string& name) {
  if (image_format(bytes, name) != ImageFormat::png)
    fail("{} is not a PNG; save the scribble as an RGBA PNG.", name);
  Image image = decode_png(bytes, name);
  if (image.channels != 4)
    fail(
        "{} has no alpha channel; save the scribble as RGBA PNG, opaque where it paints and transparent "
        "elsewhere.",
        name);
  return image;
}

void require_size(const Image& scribble, const View& view, const std::string& name) {
  const Camera &c = view.camera, &photo = view.file_camera();
  if (scribble.width != c.width || scribble.height != c.height)
    fail("{} is {}x{} pixels, view {} is {}x{}; paint on an image of the view's size.", name, scribble.width,
         scribble.height, view.name, photo.width, photo.height);
}

void require_paint(const Image& scribble, const std::string& name) {
  const float smallest = min_alpha(scribble);
  for (size_t i = 3; i < scribble.data.size(); i += 4)
    if (scribble.data[i] >= smallest) return;
  fail("Nothing in {} is opaque (alpha at least one half): there is nothing to paint.", name);
}

Scribble scribble_of(const EditContext& context, const EditJob& job, const Json& j) {
  JsonReader stroke(j, fmt::format("A stroke of edit {}", job.id));
  const EditPlace view = place_from(context.capture, stroke);
  const std::string name = stroke.optional<std::string>("file", "the scribble");
  Scribble s;
  const std::string& file = job.input(stroke.optional<std::string>("input", "scribble.png"));
  s.image = drawn_on_view(view, decode_scribble(file, name));
  stroke.finish();
  require_size(s.image, view, name);
  require_paint(s.image, name);
  s.camera = context.scene.normalization.unit_from_capture(view.camera);
  return s;
}

Json report_json(const PaintReport& r) {
  return {{"painted_pixels", r.painted_pixels},
          {"missed_pixels", r.missed_pixels},
          {"unchanged_pixels", r.unchanged_pixels},
          {"points", r.points},
          {"refined", r.refined},
          {"mean_error", r.mean_error},
          {"max_error", r.max_error},
          {"out_of_reach", r.out_of_reach},
          {"seconds", {{"trace", r.trace_seconds}, {"fit", r.train_seconds}}}};
}

PaintTarget target_of(JsonReader& params) {
  const std::string name = params.optional<std::string>("target", "albedo");
  if (const auto target = paint_target_from_name(name)) return *target;
  fail("Paint has no target '{}' in this program; update cei3d.", name);
}

Routing routing_of(JsonReader& params) {
  const std::string name = params.optional<std::string>("routing", "both");
  if (const auto routing = routing_from_name(name)) return *routing;
  fail("Paint has no routing '{}' in this program; update cei3d.", name);
}

EditOutcome make(const EditContext& context, const EditJob& job) {
  JsonReader params = job.reader();
  PaintRequest request;
  request.id = job.id;
  request.seed = params.require<uint64_t>("seed");
  request.erase = params.optional("erase", false);
  request.routing = routing_of(params);
  request.theta = params.optional("theta", 0.0f) * float(context.scene.normalization.scale);
  request.learn_one_color = settings_from(params, branch_settings(), request.branch);
  const Effects effects = effects_from_params(params);
  request.material = effects.change;
  request.color = effects.color;
  const PaintTarget target = target_of(params);
  request.unlit = target == PaintTarget::radiance;
  params.has("view");  // the names of the strokes' views, for lists
  for (const Json& stroke : params.array("strokes"))
    request.scribbles.push_back(scribble_of(context, job, stroke));
  params.finish();
  std::optional<SceneLight> light;
  if (target == PaintTarget::appearance) {
    light.emplace(context.frames.light(context.scene));
    request.seen_in = &*light;
  }
  PaintResult result = paint(context.device, context.scene, request, context.progress);
  return {std::move(result.layer), report_json(result.report)};
}

// The first version of the parameters was one stroke.
Json migrate(Json params, int) {
  if (params.contains("strokes")) return params;
  Json stroke = {{"view", params.value("view", "")}, {"input", "scribble.png"}};
  if (params.contains("file")) {
    stroke["file"] = params["file"];
    params.erase("file");
  }
  params["strokes"] = Json::array({std::move(stroke)});
  return params;
}

Aspects depends(const Json& stored) {
  JsonReader params(stored, "The parameters of a paint edit");
  const bool seen = target_of(params) == PaintTarget::appearance;
  const bool everything = routing_of(params) == Routing::none;
  const Effects effects = effects_from_params(params);
  const bool compares = target_of(params) == PaintTarget::albedo && !params.optional("erase", false) &&
                        !effects.color && effects.change.empty();  // with the albedo below
  return {.shape = true, .look = seen || everything || compares, .light = seen};
}

}  // namespace

// Version 2: several strokes; version 3: materials, also erased ones; version 4: cameras of their own,
// labeled handler points; version 5: paint of one color without a network.
const EditOp kPaintOp{"paint", 5, make, depends, migrate};

}  // namespace cei3d
