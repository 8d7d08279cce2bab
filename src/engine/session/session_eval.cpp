// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>

#include "core/base/error.h"
#include "core/compute/device.h"
#include "engine/io/capture_images.h"
#include "engine/io/image_file.h"
#include "engine/metrics/psnr.h"
#include "engine/metrics/ssim.h"
#include "engine/project/project.h"
#include "engine/render/scene_light.h"
#include "engine/session/cameras.h"
#include "engine/session/frame_files.h"
#include "engine/session/session.h"

namespace cei3d {
namespace fs = std::filesystem;
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

ViewScore score_view(const View& view, const Image& rendered) {
  const Image photo = rounded_srgb(load_linear_rgba(view));
  const Image a = over_background(rendered, 1), b = over_background(photo, 1);
  return {view.name, psnr(a, b), ssim(a, b), psnr_in_mask(a, b, mask_of(photo))};
}

void summarise(EvalReport& r) {
  size_t masked = 0;
  r.psnr_worst = INFINITY;
  for (const ViewScore& v : r.views) {
    r.psnr += v.psnr / double(r.views.size());
    r.ssim += v.ssim / double(r.views.size());
    if (v.psnr_masked) {
      r.psnr_masked += *v.psnr_masked;
      ++masked;
    }
    if (v.psnr < r.psnr_worst || r.worst_view.empty()) {
      r.psnr_worst = v.psnr;
      r.worst_view = v.view;
    }
  }
  r.psnr_masked /= double(std::max<size_t>(masked, 1));
}

fs::path picture_like(const fs::path& folder, const View& view) {
  return folder / (fs::path(view.name).filename().string() + ".png");
}

// Bright pixels.
std::vector<uint8_t> read_mask(const fs::path& path, const Camera& c) {
  const Image image = read_image(path);
  if (image.width != c.width || image.height != c.height)
    fail("{} is {}x{} pixels, its view {}x{}.", path.string(), image.width, image.height, c.width, c.height);
  std::vector<uint8_t> mask(size_t(image.width) * image.height);
  for (size_t i = 0; i < mask.size(); ++i) mask[i] = image.data[i * size_t(image.channels)] > 0.5f;
  return mask;
}

Image read_rgba(const fs::path& path, const Camera& c) {
  Image image = read_image(path);
  if (image.width != c.width || image.height != c.height)
    fail("{} is {}x{} pixels, its view {}x{}.", path.string(), image.width, image.height, c.width, c.height);
  if (image.channels == 4) return image;
  Image rgba(image.width, image.height, 4, 1);
  for (int y = 0; y < image.height; ++y)
    for (int x = 0; x < image.width; ++x) {
      const Vec3f v = image.rgb(x, y);
      for (int k = 0; k < 3; ++k) rgba.at(x, y)[k] = v[k];
    }
  return rgba;
}

std::vector<uint8_t> dilated(const std::vector<uint8_t>& mask, int width, int height, int radius) {
  std::vector<uint8_t> out(mask.size());
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x) {
      if (!mask[size_t(y) * width + x]) continue;
      for (int v = max(y - radius, 0); v <= min(y + radius, height - 1); ++v)
        for (int u = max(x - radius, 0); u <= min(x + radius, width - 1); ++u) out[size_t(v) * width + u] = 1;
    }
  return out;
}

// Squared error inside the mask, and what changed farther than two pixels from it.
struct EditSums {
  double squared = 0;
  EditScore score;

  void add(const Image& edited, const Image& before, const Image& truth, const std::vector<uint8_t>& mask) {
    constexpr int kGrow = 2;  // pixels: the mask's own border is not leakage
    const std::vector<uint8_t> grown = dilated(mask, edited.width, edited.height, kGrow);
    const Image a = over_background(edited, 1), b = over_background(truth, 1);
    for (size_t i = 0; i < mask.size(); ++i) {
      if (mask[i]) {
        ++score.pixels_inside;
        for (size_t c = 0; c < 3; ++c) squared += square(double(a.data[3 * i + c]) - b.data[3 * i + c]);
      }
      if (grown[i]) continue;
      ++score.pixels_outside;
      score.changed_outside += !std::equal(&edited.data[4 * i], &edited.data[4 * i] + 4, &before.data[4 * i]);
    }
    ++score.views;
  }
  EditScore result() {
    score.psnr_inside = -10 * std::log10(squared / double(3 * std::max<size_t>(score.pixels_inside, 1)));
    return score;
  }
};

// The object as if one of its edits had not been made.
Scene scene_without(Scene base, const Scene& scene, const std::string& edit) {
  const auto is_it = [&](const EditLayer& l) { return l.id == edit; };
  if (std::none_of(scene.layers.begin(), scene.layers.end(), is_it))
    fail_usage("There is no edit '{}' that is on; `cei3d log` lists them.", edit);
  for (const EditLayer& l : scene.layers)
    if (!is_it(l)) base = with_layer(std::move(base), l);
  return base;
}

}  // namespace

EvalReport Session::evaluate(const EvalRequest& request, Progress& progress) {
  const std::vector<View> views = views_to_score(project(), request);
  const Scene scene = project().scene();
  const Scene without = request.edit.empty() ? scene : scene_without(project().base(), scene, request.edit);
  const SceneLight lit = light(scene), lit_without = request.edit.empty() ? lit : light(without);
  const auto trace = [&](const Scene& s, const View& v) {
    return trace_view(*device_, s, s.normalization.unit_from_input(v.camera), request.samples);
  };
  const auto picture_without = [&](const View& v, const GBuffer& buffer) {
    const bool same_shape = without.surface == scene.surface;
    return rounded_srgb(
        shade_view(*device_, without, lit_without, same_shape ? buffer : trace(without, v)).rgb);
  };
  EvalReport report;
  EditSums edit;
  for (size_t i = 0; i < views.size(); ++i) {
    if (progress.cancelled()) throw Error(ErrorCode::interrupted, "Evaluation was interrupted.");
    progress.report({"eval", double(i) / double(views.size()), -1, views[i].name});
    const GBuffer buffer = trace(scene, views[i]);
    const Image rendered = rounded_srgb(shade_view(*device_, scene, lit, buffer).rgb);
    const Image before = request.edit.empty() ? rendered : picture_without(views[i], buffer);
    report.views.push_back(score_view(views[i], before));
    const fs::path truth = picture_like(request.truth, views[i]),
                   mask = picture_like(request.masks, views[i]);
    if (!request.edit.empty() && fs::exists(truth) && fs::exists(mask))
      edit.add(rendered, before, read_rgba(truth, views[i].camera), read_mask(mask, views[i].camera));
  }
  summarise(report);
  if (!request.edit.empty()) {
    if (edit.score.views == 0)
      fail("{} and {} hold no pictures named like the views ({}.png).", request.truth.string(),
           request.masks.string(), fs::path(views.front().name).filename().string());
    report.edit = edit.result();
  }
  return report;
}

}  // namespace cei3d
