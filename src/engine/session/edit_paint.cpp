// SPDX-License-Identifier: Apache-2.0
#include "core/base/error.h"
#include "engine/edit/paint.h"
#include "engine/io/capture.h"
#include "engine/io/image_file.h"
#include "engine/io/png_file.h"
#include "engine/session/edit_ops.h"

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
  const Camera& c = view.camera;
  if (scribble.width != c.width || scribble.height != c.height)
    fail("{} is {}x{} pixels, view {} is {}x{}; paint on a picture of the view's own size.", name,
         scribble.width, scribble.height, view.name, c.width, c.height);
}

void require_paint(const Image& scribble, const std::string& name) {
  for (size_t i = 3; i < scribble.data.size(); i += 4)
    if (scribble.data[i] >= 0.5f) return;
  fail("Nothing in {} is opaque (alpha at least one half): there is nothing to paint.", name);
}

Json report_json(const PaintReport& r) {
  return {{"painted_pixels", r.painted_pixels},
          {"missed_pixels", r.missed_pixels},
          {"points", r.points},
          {"mean_error", r.mean_error},
          {"max_error", r.max_error},
          {"seconds", {{"trace", r.trace_seconds}, {"fit", r.train_seconds}}}};
}

EditOutcome make(const EditContext& context, const EditJob& job) {
  const View& view = find_view(context.capture, job.params.at("view").get<std::string>());
  const std::string name = job.params.value("file", "the scribble");
  PaintRequest request;
  request.scribble = decode_scribble(job.input("scribble.png"), name);
  require_size(request.scribble, view, name);
  require_paint(request.scribble, name);
  request.camera = context.scene.normalization.unit_from_input(view.camera);
  request.id = job.id;
  request.seed = job.params.at("seed").get<uint64_t>();
  PaintResult result = paint(context.device, context.scene, request, context.progress);
  return {std::move(result.layer), report_json(result.report)};
}

Aspects depends(const Json&) { return {.shape = true}; }

}  // namespace

const EditOp kPaintOp{"paint", 1, make, depends};

}  // namespace cei3d
