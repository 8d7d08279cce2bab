// SPDX-License-Identifier: Apache-2.0
#include "engine/session/edit_score.h"

#include <algorithm>
#include <cmath>

#include "core/base/error.h"
#include "core/math/psnr.h"
#include "engine/io/image_file.h"
#include "engine/metrics/flip.h"
#include "engine/metrics/psnr.h"
#include "engine/metrics/ssim.h"
#include "model/scene/parts.h"

namespace cei3d {
namespace fs = std::filesystem;
namespace {

constexpr int kGrow = 2;  // pixels: an edit's own border is neither leakage nor the rest of the object

Image read_of_view(const fs::path& path, const Camera& c) {
  Image image = read_image(path);
  if (image.width != c.width || image.height != c.height)
    fail("{} is {}x{} pixels, its view {}x{}.", path.string(), image.width, image.height, c.width, c.height);
  return image;
}

// Bright pixels.
Area read_area(const fs::path& path, const Camera& c) {
  const Image image = read_of_view(path, c);
  Area area(size_t(image.width) * image.height);
  for (size_t i = 0; i < area.size(); ++i) area[i] = image.data[i * size_t(image.channels)] > 0.5f;
  return area;
}

bool same_pixel(const Image& a, const Image& b, size_t i) {
  return std::equal(&a.data[4 * i], &a.data[4 * i] + 4, &b.data[4 * i]);
}

}  // namespace

fs::path image_like(const fs::path& folder, const View& view) {
  return folder / (fs::path(view.name).filename().string() + ".png");
}

EditedArea edited_area(const Scene& scene, const EditLayer& layer, const GBuffer& g, const EditImages& p) {
  const std::vector<uint8_t> inside = inside_layer(scene, layer, g.hits);
  EditedArea area;
  for (size_t i = 0; i + 1 < g.pixel_start.size(); ++i) {
    const uint32_t samples = uint32_t(g.samples_of(i));
    uint32_t hits = layer.everywhere || layer.light ? samples : 0;
    for (uint32_t h = g.pixel_start[i]; h < g.pixel_start[i + 1]; ++h) hits += inside[h];
    if (layer.reshape && !same_pixel(p.before, p.after, i)) hits = samples;
    area.any.push_back(hits > 0);
    area.half.push_back(2 * hits >= samples);
  }
  return area;
}

void EditScorer::add(const View& view, const EditImages& p, const EditedArea& own) {
  const fs::path mask_file = image_like(masks_, view);
  const bool has_truth = !truth_.empty() && fs::exists(image_like(truth_, view)) && fs::exists(mask_file);
  const Area mask = has_truth ? read_area(mask_file, view.camera) : own.any;
  if (has_truth) add_truth(view, p, mask, own.half);
  if (has_truth || truth_.empty()) add_rest(p, dilated(mask, p.after.width, p.after.height, kGrow));
  perceptual_.add(before_, over_background(p.before, 1));
  perceptual_.add(after_, over_background(p.after, 1));
}

void EditScorer::add_truth(const View& view, const EditImages& p, const Area& mask, const Area& own) {
  const Image truth = over_background(read_of_view(image_like(truth_, view), view.camera), 1);
  const Image after = over_background(p.after, 1);
  const Area grown = dilated(mask, p.after.width, p.after.height, kGrow);
  for (size_t i = 0; i < mask.size(); ++i) {
    for (size_t c = 0; mask[i] && c < 3; ++c)
      squared_error_ += square(double(after.data[3 * i + c]) - truth.data[3 * i + c]);
    in_both_ += mask[i] && own[i];
    in_either_ += mask[i] || own[i];
    fidelity_.pixels_inside += mask[i];
    fidelity_.pixels_outside += !grown[i];
    fidelity_.changed_outside += !grown[i] && !same_pixel(p.after, p.before, i);
  }
  ++fidelity_.views;
}

void EditScorer::add_rest(const EditImages& p, const Area& grown) {
  Area rest(grown.size());
  for (size_t i = 0; i < rest.size(); ++i) rest[i] = p.photo.data[4 * i + 3] > 0.5f && !grown[i];
  const Image photo = over_background(p.photo, 1), after = over_background(p.after, 1);
  const std::optional<double> similar = ssim_in_area(after, photo, rest);
  if (!similar) return;
  rest_.psnr += *psnr_in_mask(after, photo, rest);
  rest_.ssim += *similar;
  rest_.flip = rest_.flip.value_or(0) + *flip_in_area(photo, after, rest);
  if (const auto d = perceptual_.distance(shown_in(after, rest, 1), shown_in(photo, rest, 1)))
    rest_.lpips = rest_.lpips.value_or(0) + *d;
  rest_.pixels += pixels_in(rest);
  ++rest_.views;
}

EditScore EditScorer::result() const {
  EditScore score;
  if (!truth_.empty()) {
    if (fidelity_.views == 0)
      fail("{} and {} hold no images named like the views (r_004.png for test/r_004).", truth_.string(),
           masks_.string());
    score.truth = fidelity_;
    score.truth->iou = double(in_both_) / double(std::max<size_t>(in_either_, 1));
    score.truth->psnr_inside =
        psnr_of_mse(squared_error_ / double(3 * std::max<size_t>(fidelity_.pixels_inside, 1)));
  }
  if (rest_.views > 0) {
    const double n = double(rest_.views);
    score.rest = RestScore{rest_.psnr / n, rest_.ssim / n, {}, *rest_.flip / n, rest_.pixels, rest_.views};
    if (rest_.lpips) score.rest->lpips = *rest_.lpips / n;
  }
  score.fid = perceptual_.frechet(before_, after_);
  return score;
}

}  // namespace cei3d
