// SPDX-License-Identifier: Apache-2.0
#include <charconv>

#include "core/base/error.h"
#include "core/base/json.h"
#include "engine/capture/capture.h"
#include "engine/capture/capture_images.h"
#include "engine/capture/undistort.h"
#include "engine/edit/part.h"
#include "engine/edit/part_seeds.h"
#include "engine/edit/sam_part.h"
#include "engine/io/image_file.h"
#include "engine/io/png_file.h"
#include "engine/session/edit_ops.h"
#include "engine/session/edit_params.h"

namespace cei3d {
namespace {

std::vector<Vec2f> pixels_from(JsonReader& params, const char* key) {
  std::vector<Vec2f> pixels;
  if (!params.has(key)) return pixels;
  for (const Json& p : params.array(key)) pixels.push_back({p.at(0).get<float>(), p.at(1).get<float>()});
  return pixels;
}

std::optional<PartLikeness> likeness_from(JsonReader& params) {
  const bool color = params.optional("like_color", false);
  if (!params.has("like")) return std::nullopt;
  const auto [x, y] = params.numbers<2>("like");
  return PartLikeness{{float(x), float(y)}, color};
}

// Inside where it is opaque, when it is not so everywhere; else where it is bright.
Image decode_mask(const std::string& bytes, const std::string& name) {
  if (image_format(bytes, name) != ImageFormat::png) fail("{} is not a PNG; save the mask as one.", name);
  const Image picture = decode_png(bytes, name);
  const int channels = picture.channels;
  bool transparent = false;
  for (size_t i = 3; channels == 4 && i < picture.data.size(); i += 4) transparent |= picture.data[i] < 0.5f;
  Image mask(picture.width, picture.height, 1);
  for (size_t i = 0; i < mask.data.size(); ++i) {
    const float* p = &picture.data[i * channels];
    const float bright = channels < 3 ? p[0] : (p[0] + p[1] + p[2]) / 3;
    mask.data[i] = transparent ? p[3] : bright;
  }
  return mask;
}

std::optional<PartCombination> combination_from(JsonReader& params) {
  using How = PartCombination::How;
  std::optional<PartCombination> combination;
  for (const auto& [key, how] :
       {std::pair{"add", How::add}, {"subtract", How::subtract}, {"intersect", How::intersect}})
    if (const auto part = params.optional<std::string>(key); part && !combination) combination = {how, *part};
  return combination;
}

Image decode_scribble(const std::string& bytes, const std::string& name) {
  if (image_format(bytes, name) != ImageFormat::png)
    fail("{} is not a PNG; save the scribble as an RGBA PNG.", name);
  return decode_png(bytes, name);
}

std::optional<PartScribble> scribble_from(JsonReader& params, const EditJob& job, const View& view) {
  const auto name = params.optional<std::string>("scribble");
  const auto negative = params.optional<std::string>("negative_scribble");
  const auto negative_color = params.optional<std::string>("negative_color");
  if (!name) return std::nullopt;
  return part_scribble(
      drawn_on_view(view, decode_scribble(job.input("scribble.png"), *name)),
      negative ? drawn_on_view(view, decode_scribble(job.input("negative.png"), *negative)) : Image(),
      negative_color ? std::optional(color_from_text(*negative_color)) : std::nullopt);
}

int views_from(JsonReader& params) {
  const auto text = params.optional<std::string>("views");
  if (!text) return ViewPlan().max_views;
  if (*text == "all") return ViewPlan::kAll;
  int n = 0;
  const auto [end, error] = std::from_chars(text->data(), text->data() + text->size(), n);
  if (error != std::errc() || end != text->data() + text->size() || n < 1)
    fail("{} has '{}' views; a number or `all` belongs there.", params.what(), *text);
  return n;
}

NetworkViews network_from(JsonReader& params) {
  NetworkViews n;
  n.photographs = params.optional<std::string>("on", "renders") == "photographs";
  n.plan.max_views = views_from(params);
  const auto order = view_order_from_name(params.optional<std::string>("order", "informative"));
  const auto combination = mask_combination_from_name(params.optional<std::string>("combine", "votes"));
  if (!order || !combination)
    fail("{} has an order or combination of views that this program does not know; update cei3d.",
         params.what());
  n.plan.order = *order;
  n.plan.combination = *combination;
  return n;
}

// Views for the network: that of the prompts first, then the training views. It sees renders of the present
// object, unless photographs are asked for.
std::vector<float> scores_by_network(const EditContext& context, const NetworkViews& network,
                                     const Scene& scene, const PartRequest& r, Progress& progress) {
  SamPartRequest request;
  request.views.cameras = {r.camera};
  std::vector<const View*> views{nullptr};
  for (const View& v : context.capture.views) {
    if (v.name == r.view) views[0] = &v;
    if (v.split != Split::train || v.name == r.view) continue;
    views.push_back(&v);
    request.views.cameras.push_back(scene.normalization.unit_from_capture(v.camera));
  }
  request.views.plan = network.plan;
  request.graph = r.options.graph;
  request.views.mask = r.mask;
  request.views.clicks = network_prompts(context.device, scene, r);
  if (r.scribble || !r.mask.empty()) request.certain = part_seeds(context.device, scene, r);
  if (network.photographs) request.image = [&](int view) { return load_linear_rgba(*views[size_t(view)]); };
  return sam_part(context.device, scene, request, context.sam, progress).scores;
}

PartRequest request_of(const EditContext& context, const EditJob& job) {
  JsonReader params = job.reader();
  const EditPlace view = place_from(context.capture, params);
  const Effects effects = effects_from_params(params);
  PartRequest r;
  r.id = job.id;
  r.name = params.require<std::string>("name");
  r.view = view.name;
  r.camera = context.scene.normalization.unit_from_capture(view.camera);
  r.clicks = {pixels_from(params, "positive"), pixels_from(params, "negative")};
  if (const auto mask = params.optional<std::string>("mask"))
    r.mask = drawn_on_view(view, decode_mask(job.input("mask.png"), *mask));
  r.scribble = scribble_from(params, job, view);
  r.keep_color = params.optional("keep_color", false);
  const bool keep_texture = params.optional("keep_texture", false);
  const NetworkViews network = network_from(params);
  if (network.photographs && !view.is_view)
    fail("Part {} was clicked in a camera of its own, which has no photograph for the network.", r.name);
  if (params.optional<std::string>("segmenter", "grow") == "sam")
    r.network = [&context, network](const Scene& scene, const PartRequest& request, Progress& progress) {
      return scores_by_network(context, network, scene, request, progress);
    };
  r.like = likeness_from(params);
  r.in_view = params.optional("in_view", false);
  settings_from(params, part_settings(), r.options);
  r.combination = combination_from(params);
  params.finish();
  r.change = effects.change;
  r.color = effects.color;
  r.keep_texture = effects.color ? !effects.replace : keep_texture;
  return r;
}

EditOutcome make(const EditContext& context, const EditJob& job) {
  PartResult result = select_part(context.device, context.scene, request_of(context, job), context.progress);
  const PartReport& r = result.report;
  return {std::move(result.layer),
          {{"part", job.params.at("name")},
           {"points", r.points},
           {"share", r.share},
           {"seconds",
            {{"clicks", r.seed_seconds}, {"select", r.select_seconds}, {"effects", r.color_seconds}}}}};
}

// The border of a part depends on color and material.
Aspects depends(const Json& params) {
  JsonReader reader(params, "The parameters of a part");
  return {.shape = true, .look = true, .parts = combination_from(reader).has_value()};
}

}  // namespace

// Version 2: scales, blends and presets; parts of like material. Version 3: a camera of its own; scribbles;
// the network's views.
const EditOp kPartOp{"part", 3, make, depends};

}  // namespace cei3d
