// SPDX-License-Identifier: Apache-2.0
#include "engine/photos/first_masks.h"

#include <algorithm>

#include "core/base/cancel.h"
#include "core/math/quantile.h"
#include "engine/io/image_file.h"
#include "engine/photos/photo_pixels.h"

namespace cei3d {
namespace fs = std::filesystem;
namespace {

constexpr size_t kPrompts = 4;           // number of prompts of each kind
constexpr float kPrior = 3;              // number of masks that outweigh what the place of a point says
constexpr float kSaliencyWeight = 0.8f;  // what the belief in a point gains at most by its saliency
constexpr double kMargin = 0.05;         // margin of the box around the points, as a share of its longer side

float value_at(const Image& image, Vec2f p) {
  return *image.at(std::clamp(int(p.x), 0, image.width - 1), std::clamp(int(p.y), 0, image.height - 1));
}

// Two corners of the box around the pixels without the outermost ones, which may be mistakes.
std::vector<Vec2f> without_strays(const std::vector<Vec2f>& pixels) {
  constexpr double kStrays = 0.01;  // share of the pixels that is left out at each side
  std::vector<float> x, y;
  for (const Vec2f p : pixels) x.push_back(p.x), y.push_back(p.y);
  const auto low = size_t(kStrays * double(x.size())), high = x.size() - 1 - low;
  return {{value_of_rank(x, low), value_of_rank(y, low)}, {value_of_rank(x, high), value_of_rank(y, high)}};
}

class FirstRound {
 public:
  FirstRound(const MaskRequest& r, const SparsePoints& points, PhotoSegmenter& segmenter)
      : request_(r), points_(points), segmenter_(segmenter) {
    votes_.resize(points.positions.size());
    belief_ = split_points(points, r.views).belief;
    if (r.clicks.empty()) return;
    for (float& b : belief_)
      if (!is_background(b)) b = 0;  // with clicks, only the background is known
  }

  PointBelief beliefs() const {
    PointBelief out;
    for (uint32_t p = 0; p < votes_.size(); ++p) out.push_back(belief(p));
    return out;
  }

  void run(double first, double last, Progress& progress) {
    const size_t n = request_.views.size();
    if (request_.clicks.empty()) weigh_saliency(first, progress);
    std::vector<uint8_t> done(n);
    for (size_t i = 0; i < n; ++i) {
      check_cancelled(progress, "Interrupted; the same command goes on from here.");
      progress.report({"masks", first + (last - first) * double(i) / double(n), -1, ""});
      const size_t view = next(done);
      if (view == n) break;
      done[view] = 1;
      learn(view, mask_of(view));
    }
  }

 private:
  static bool is_background(float belief) { return belief <= -1; }

  // Salient points are more likely on the object than others.
  void weigh_saliency(double done, Progress& progress) {
    std::vector<float> sum(belief_.size());
    std::vector<int> count(belief_.size());
    for (size_t v = 0; v < request_.views.size(); ++v) {
      check_cancelled(progress, "Interrupted; the same command goes on from here.");
      progress.report({"masks", done, -1, "saliency"});
      const View& view = request_.views[v];
      const std::optional<Image> saliency = segmenter_.saliency(view);
      if (!saliency) return;
      const Camera& file = view.file_camera();
      for (const auto& s : points_.views[v]) {
        sum[s.point] += value_at(*saliency, {s.pixel.x * float(saliency->width) / float(file.width),
                                             s.pixel.y * float(saliency->height) / float(file.height)});
        ++count[s.point];
      }
    }
    for (size_t p = 0; p < belief_.size(); ++p)
      if (count[p] > 0 && !is_background(belief_[p]))
        belief_[p] =
            std::clamp(belief_[p] + kSaliencyWeight * (2 * sum[p] / float(count[p]) - 1), -1.0f, 1.0f);
  }

  // Of the views that are not done the one that shows most points of the object; clicked views come first.
  // The number of views: none shows any point.
  size_t next(const std::vector<uint8_t>& done) const {
    size_t best = request_.views.size(), largest = 0;
    for (size_t v = 0; v < done.size(); ++v) {
      if (done[v]) continue;
      if (clicked(v)) return v;
      size_t count = 0;
      for (const auto& s : points_.views[v]) count += belief(s.point) > 0;
      if (count > largest) largest = count, best = v;
    }
    return best;
  }
  bool clicked(size_t view) const {
    return std::any_of(request_.clicks.begin(), request_.clicks.end(),
                       [&](const PhotoClick& c) { return c.view == view && c.object; });
  }
  float belief(uint32_t point) const { return kPrior * belief_[point] + float(votes_[point]); }

  // Around all points of the object, also those that are hidden or not found in this view.
  std::optional<PixelBox> around(const View& v) const {
    std::vector<Vec2f> pixels;
    for (uint32_t p = 0; p < votes_.size(); ++p) {
      if (belief(p) <= 0) continue;
      const std::optional<Vec2d> at = photo_pixel(v, points_.positions[p]);
      if (at) pixels.push_back({float(at->x), float(at->y)});
    }
    if (pixels.size() < 3) return std::nullopt;
    return box_around(without_strays(pixels), kMargin, whole(v));
  }

  Prompts prompts_of(size_t view) const {
    Prompts prompts;
    for (const PhotoClick& c : request_.clicks)
      if (c.view == view) (c.object ? prompts.positive : prompts.negative).push_back(c.pixel);
    BelievedPixels pixels;
    for (const auto& s : points_.views[view]) {
      const float b = belief(s.point);
      (b > 0 ? pixels.in : b < 0 ? pixels.out : pixels.unknown).push_back(s.pixel);
    }
    if (!clicked(view)) add_prompts(pixels, kPrompts, prompts);
    return prompts;
  }
  Image mask_of(size_t view) {
    const View& v = request_.views[view];
    const fs::path file = request_.first_masks / (v.name + ".png");
    if (fs::exists(file)) return read_image(file);
    const Prompts prompts = prompts_of(view);
    if (prompts.positive.empty()) return {};
    const Image mask = mask_image(segmenter_.log_odds(v, whole(v), prompts, around(v)), whole(v), v);
    write_png(file, mask);
    return mask;
  }
  void learn(size_t view, const Image& mask) {
    if (mask.empty()) return;
    for (const auto& s : points_.views[view]) votes_[s.point] += value_at(mask, s.pixel) > 0.5f ? 1 : -1;
  }

  const MaskRequest& request_;
  const SparsePoints& points_;
  PhotoSegmenter& segmenter_;
  PointBelief belief_;
  std::vector<int> votes_;
};

}  // namespace

PointBelief make_first_masks(const MaskRequest& r, const SparsePoints& points, PhotoSegmenter& segmenter,
                             double first, double last, Progress& progress) {
  FirstRound round(r, points, segmenter);
  round.run(first, last, progress);
  return round.beliefs();
}

}  // namespace cei3d
