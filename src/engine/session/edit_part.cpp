// SPDX-License-Identifier: Apache-2.0
#include "core/base/error.h"
#include "engine/capture/capture.h"
#include "engine/capture/undistort.h"
#include "engine/edit/part.h"
#include "engine/edit/sam_part.h"
#include "engine/io/image_file.h"
#include "engine/io/png_file.h"
#include "engine/segment/sam.h"
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

// Cameras for the network: the clicked view first, then the training views. It sees renders of the present
// object, not photographs.
std::vector<float> scores_by_network(const EditContext& context, const std::string& view, const Scene& scene,
                                     const PartRequest& r, Progress& progress) {
  SamPartRequest request;
  request.networks = installed_sam();
  request.views.clicks = r.clicks;
  request.views.cameras = {r.camera};
  for (const View& v : context.capture.views)
    if (v.split == Split::train && v.name != view)
      request.views.cameras.push_back(scene.normalization.unit_from_capture(v.camera));
  return sam_part(context.device, scene, request, progress).scores;
}

PartRequest request_of(const EditContext& context, const EditJob& job) {
  JsonReader params = job.reader();
  const View& view = find_view(context.capture, params.require<std::string>("view"));
  const Effects effects = effects_from_params(params);
  PartRequest r;
  r.id = job.id;
  r.name = params.require<std::string>("name");
  r.view = view.name;
  r.camera = context.scene.normalization.unit_from_capture(view.camera);
  r.clicks = {pixels_from(params, "positive"), pixels_from(params, "negative")};
  if (const auto mask = params.optional<std::string>("mask"))
    r.mask = drawn_on_view(view, decode_mask(job.input("mask.png"), *mask));
  if (params.optional<std::string>("segmenter", "grow") == "sam")
    r.network = [&context, name = view.name](const Scene& scene, const PartRequest& request,
                                             Progress& progress) {
      return scores_by_network(context, name, scene, request, progress);
    };
  r.like = likeness_from(params);
  r.in_view = params.optional("in_view", false);
  r.combination = combination_from(params);
  params.finish();
  r.change = effects.change;
  r.color = effects.color;
  r.keep_texture = !effects.replace;
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

// Version 2: scales, blends and presets; parts of like material.
const EditOp kPartOp{"part", 2, make, depends};

}  // namespace cei3d
