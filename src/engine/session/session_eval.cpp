// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>

#include "core/base/cancel.h"
#include "core/base/error.h"
#include "core/base/parallel.h"
#include "core/compute/device.h"
#include "core/image/exposure.h"
#include "engine/capture/capture_images.h"
#include "engine/io/image_file.h"
#include "engine/metrics/flip.h"
#include "engine/metrics/psnr.h"
#include "engine/metrics/ssim.h"
#include "engine/project/project.h"
#include "engine/render/render_cache.h"
#include "engine/session/cameras.h"
#include "engine/session/edit_score.h"
#include "engine/session/frame_files.h"
#include "engine/session/session.h"

namespace cei3d {
namespace {

std::vector<View> views_to_score(const Project& project, const EvalRequest& request) {
  std::vector<View> views = choose_views(project, request.capture, request.split);
  if (!request.split) {  // held-out views where there are any
    std::vector<View> test;
    for (const View& v : views)
      if (v.split == Split::test) test.push_back(v);
    if (!test.empty()) views = test;
  }
  std::erase_if(views, [](const View& v) { return v.image_path.empty(); });
  if (views.empty()) fail("There are no photographs to compare with.");
  return views;
}

std::vector<uint8_t> mask_of(const Image& rgba) {
  std::vector<uint8_t> mask(size_t(rgba.width) * rgba.height);
  for (size_t i = 0; i < mask.size(); ++i) mask[i] = rgba.data[4 * i + 3] > 0.5f;
  return mask;
}

// Pixels that the photograph says nothing about are background in every picture, so that they do not count.
Image where_known(const Image& photo, Image picture) {
  for (size_t i = 3; i < photo.data.size(); i += 4)
    if (photo.data[i] < 0) picture.data[i] = 0;
  return picture;
}

// Both sets of images, for the distance between them.
struct Sets {
  FeatureSet rendered, photos;
};

ViewScore score_view(const View& view, const Image& rendered, const Image& photo,
                     const Perceptual& perceptual, Sets& sets) {
  const Image a = over_background(rendered, 1), b = over_background(photo, 1);
  perceptual.add(sets.rendered, a);
  perceptual.add(sets.photos, b);
  const std::vector<uint8_t> mask = mask_of(photo);
  const std::optional<Vec3f> exposure = exposure_between(a, b, mask);
  return {view.name,
          psnr(a, b),
          ssim(a, b),
          psnr_in_mask(a, b, mask),
          psnr_in_mask(exposure ? exposed(a, *exposure) : a, b, mask),
          perceptual.distance(a, b),
          flip(b, a)};
}

// Progress of one view as a share of all.
void add_mean(const Image& rendered, const Image& photo, size_t views, EvalReport::Alone& mean) {
  const Image a = over_background(rendered, 1), b = over_background(photo, 1);
  mean.psnr += psnr(a, b) / double(views);
  mean.psnr_masked += psnr_in_mask(a, b, mask_of(photo)).value_or(0) / double(views);
}

void summarize(EvalReport& r) {
  size_t masked = 0;
  r.psnr_worst = INFINITY;
  for (const ViewScore& v : r.views) {
    r.psnr += v.psnr / double(r.views.size());
    r.ssim += v.ssim / double(r.views.size());
    if (v.flip) r.flip = r.flip.value_or(0) + *v.flip / double(r.views.size());
    if (v.lpips) r.lpips = r.lpips.value_or(0) + *v.lpips / double(r.views.size());
    if (v.psnr_masked) {
      r.psnr_masked += *v.psnr_masked;
      r.psnr_exposed = r.psnr_exposed.value_or(0) + v.psnr_exposed.value_or(*v.psnr_masked);
      ++masked;
    }
    if (v.psnr < r.psnr_worst || r.worst_view.empty()) {
      r.psnr_worst = v.psnr;
      r.worst_view = v.view;
    }
  }
  r.psnr_masked /= double(std::max<size_t>(masked, 1));
  if (r.psnr_exposed) *r.psnr_exposed /= double(masked);
}

// The object without one of its edits.
Scene scene_without(Scene base, const Scene& scene, const std::string& edit) {
  for (const EditLayer& l : scene.layers)
    if (l.id != edit) base = with_layer(std::move(base), l);
  return base;
}

const EditLayer* layer_of(const Scene& scene, const std::string& edit) {
  if (edit.empty()) return nullptr;
  for (const EditLayer& l : scene.layers)
    if (l.id == edit) return &l;
  fail_usage("There is no edit '{}' that is on; `cei3d log` lists them.", edit);
}

struct ScoredScenes {
  Scene scene;
  Scene without;                  // the scene without the edit that is scored; the same if none is
  std::optional<Scene> physical;  // the scene without the correction; none: it has none
};

ScoredScenes scenes_to_score(const Project& project, const EvalRequest& request) {
  Scene scene = project.scene(), base = project.base();
  if (!request.residual) scene.residual = base.residual = nullptr;
  const Scene without = layer_of(scene, request.edit) ? scene_without(base, scene, request.edit) : scene;
  std::optional<Scene> physical;
  if (without.residual) {
    physical = without;
    physical->residual = nullptr;
  }
  return {scene, without, physical};
}

Image side_by_side(const EditImages& p, bool edited) {
  std::vector<Image> pictures{p.photo, p.before};
  if (edited) pictures.push_back(p.after);
  return side_by_side(pictures);
}

}  // namespace

EvalReport Session::evaluate(const EvalRequest& request, Progress& progress) {
  return threads_->run([&]() -> EvalReport {
    const Perceptual perceptual(request.networks);
    const std::vector<View> views = views_to_score(project(), request);
    const ScoredScenes scenes = scenes_to_score(project(), request);
    const EditLayer* edit = layer_of(scenes.scene, request.edit);
    const auto trace = [&](const Scene& s, const View& v) {
      return frames_->trace(s, s.normalization.unit_from_capture(v.camera), request.samples);
    };
    const auto picture = [&](const Scene& s, const View& v) {
      const Scene lit = in_view(s, v.camera);
      return rounded_srgb(frames_->shade(lit, frames_->light(lit), *trace(lit, v)).rgb);
    };
    EvalReport report;
    if (scenes.physical) report.alone = EvalReport::Alone{};
    Sets sets;
    EditScorer scorer(request.truth, request.masks, perceptual);
    for (size_t i = 0; i < views.size(); ++i) {
      check_cancelled(progress, "Evaluation was interrupted.");
      progress.report({"eval", double(i) / double(views.size()), -1, views[i].name});
      const Image photo = load_linear_rgba(views[i]);
      EditImages p;
      p.after = where_known(photo, picture(scenes.scene, views[i]));
      p.before = edit ? where_known(photo, picture(scenes.without, views[i])) : p.after;
      p.photo = where_known(photo, rounded_srgb(photo));
      if (scenes.physical)
        add_mean(where_known(photo, picture(*scenes.physical, views[i])), p.photo, views.size(),
                 *report.alone);
      report.views.push_back(score_view(views[i], p.before, p.photo, perceptual, sets));
      if (edit)
        scorer.add(views[i], p, edited_area(scenes.scene, *edit, trace(scenes.scene, views[i])->buffer, p));
      if (!request.pictures.empty()) write_png(image_like(request.pictures, views[i]), side_by_side(p, edit));
    }
    summarize(report);
    report.residual = bool(scenes.scene.residual);
    report.fid = perceptual.frechet(sets.rendered, sets.photos);
    if (edit) report.edit = scorer.result();
    return report;
  });
}

}  // namespace cei3d
