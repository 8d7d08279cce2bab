// SPDX-License-Identifier: Apache-2.0
#include <chrono>

#include "core/base/error.h"
#include "core/base/file.h"
#include "core/compute/device.h"
#include "engine/edit/paint.h"
#include "engine/io/image_file.h"
#include "engine/io/png_file.h"
#include "engine/project/project.h"
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

// sRGB as stored. The bytes are kept with the edit.
Image decode_scribble(const std::string& bytes, const std::filesystem::path& path) {
  if (image_format(bytes, path.string()) != ImageFormat::png)
    fail("{} is not a PNG; save the scribble as an RGBA PNG.", path.string());
  Image image = decode_png(bytes, path.string());
  if (image.channels != 4)
    fail(
        "{} has no alpha channel; save the scribble as RGBA PNG, opaque where it paints and transparent "
        "elsewhere.",
        path.string());
  return image;
}

void require_size(const Image& scribble, const View& view, const std::filesystem::path& path) {
  const Camera& c = view.camera;
  if (scribble.width != c.width || scribble.height != c.height)
    fail("{} is {}x{} pixels, view {} is {}x{}; paint on a picture of the view's own size.", path.string(),
         scribble.width, scribble.height, view.name, c.width, c.height);
}

void require_paint(const Image& scribble, const std::filesystem::path& path) {
  for (size_t i = 3; i < scribble.data.size(); i += 4)
    if (scribble.data[i] >= 0.5f) return;
  fail("Nothing in {} is opaque (alpha at least one half): there is nothing to paint.", path.string());
}

Json report_json(const PaintReport& r) {
  return {{"painted_pixels", r.painted_pixels},
          {"missed_pixels", r.missed_pixels},
          {"points", r.points},
          {"mean_error", r.mean_error},
          {"max_error", r.max_error},
          {"trace_seconds", r.trace_seconds},
          {"fit_seconds", r.train_seconds}};
}

}  // namespace

PaintSummary Session::paint(const PaintCommand& command, Progress& progress) {
  Stopwatch watch;
  const View& view = find_view(project().capture(), command.view);
  const std::string bytes = read_file(command.scribble);
  PaintRequest request;
  request.scribble = decode_scribble(bytes, command.scribble);
  require_size(request.scribble, view, command.scribble);
  require_paint(request.scribble, command.scribble);
  const Scene scene = project().scene();
  request.camera = scene.normalization.unit_from_input(view.camera);
  request.id = project().stack().next_id("paint");
  request.seed = command.seed;

  PaintSummary s;
  s.id = request.id;
  s.load_seconds = watch.lap();
  const PaintResult result = cei3d::paint(*device_, scene, request, progress);
  const PaintReport& r = result.report;
  watch.lap();

  EditRecord record;
  record.id = request.id;
  record.op = "paint";
  record.params = {{"view", view.name}, {"target", "albedo"}, {"seed", command.seed}};
  record.report = report_json(r);
  record.inputs = {{"scribble.png", bytes}};
  project().add_edit(record, result.layer);
  s.store_seconds = watch.lap();

  s.painted_pixels = r.painted_pixels;
  s.missed_pixels = r.missed_pixels;
  s.points = r.points;
  s.mean_error = r.mean_error;
  s.max_error = r.max_error;
  s.trace_seconds = r.trace_seconds;
  s.train_seconds = r.train_seconds;
  return s;
}

}  // namespace cei3d
