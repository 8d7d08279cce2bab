// SPDX-License-Identifier: Apache-2.0
#include "engine/capture/mask_votes.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "core/base/parallel.h"
#include "core/math/quantile.h"
#include "engine/capture/cell_votes.h"

namespace cei3d {
namespace {

constexpr Cells kCells{96};
constexpr double kTolerance =
    0.15;  // share of the other views that may see background in a cell of the object
// Number of views nearest in direction: a hole that is really there is seen by most of them.
constexpr size_t kNear = 8;
constexpr double kNearCosine = 0.64;  // 50 degrees
constexpr size_t kMinNear = 3;        // minimum number of near views for a decision
constexpr int kOpening = 2;           // pixels: doubts about a thin outline do not count
constexpr double kShare = 0.01,
                 kOutlier = 3;  // stands out: share of doubtful pixels > kShare + kOutlier x median

constexpr double kAlike = 0.1;  // focal lengths of one camera differ by less

class Votes {
 public:
  explicit Votes(const std::vector<HullMask>& views) : views_(views), cells_(kCells, kTolerance) {
    for (const HullMask& view : views) cells_.add(samples_of(view, kCells));
    for (size_t v = 0; v < views.size(); ++v) near_.push_back(near_views(v));
  }

  const CellVotes& cells() const { return cells_; }
  // Whether most views from nearly the same direction show the object at p.
  bool supported_nearby(size_t view, Vec3d p) const {
    size_t for_it = 0, against = 0;
    for (const size_t v : near_[view]) {
      const MaskSample s = sample_mask(views_[v], p);
      for_it += s == MaskSample::object, against += s == MaskSample::background;
    }
    return for_it + against >= kMinNear && for_it > against;
  }

 private:
  std::vector<size_t> near_views(size_t view) const {
    const auto direction = [&](size_t v) { return normalize(views_[v].camera.center); };
    std::vector<std::pair<double, size_t>> others;
    for (size_t v = 0; v < views_.size(); ++v)
      if (const double cosine = dot(direction(v), direction(view)); v != view && cosine > kNearCosine)
        others.push_back({-cosine, v});
    const size_t n = std::min(kNear, others.size());
    std::partial_sort(others.begin(), others.begin() + std::ptrdiff_t(n), others.end());
    std::vector<size_t> out;
    for (size_t i = 0; i < n; ++i) out.push_back(others[i].second);
    return out;
  }

  const std::vector<HullMask>& views_;
  CellVotes cells_;
  std::vector<std::vector<size_t>> near_;
};

// Whether the ray of a pixel meets the object, by the other views. own: what the pixel itself shows.
bool meets_object(const Votes& votes, const HullMask& view, size_t index, int x, int y, MaskSample own) {
  return ray_meets(view.camera, x, y, kCells, [&](Vec3d p) {
    return votes.cells().supported(p, own) && (own == MaskSample::object || votes.supported_nearby(index, p));
  });
}

MaskDoubt judge(const Votes& votes, const HullMask& view, size_t index) {
  MaskDoubt doubt;
  const int w = doubt.width = view.camera.width, h = doubt.height = view.camera.height;
  Area missing(view.mask.size()), extra(view.mask.size());
  size_t object = 0;
  for (int y = 0; y < h; ++y)
    for (int x = 0; x < w; ++x) {
      const size_t i = size_t(y) * w + x;
      const uint8_t pixel = view.mask[i];
      object += pixel == kObject;
      if (pixel == kBackground) missing[i] = meets_object(votes, view, index, x, y, MaskSample::background);
      if (pixel == kObject) extra[i] = !meets_object(votes, view, index, x, y, MaskSample::object);
    }
  doubt.consensus = missing;
  for (size_t i = 0; i < extra.size(); ++i) doubt.consensus[i] |= view.mask[i] == kObject && !extra[i];
  missing = opened(missing, w, h, kOpening);
  extra = opened(extra, w, h, kOpening);
  const double per_object = 1.0 / double(std::max<size_t>(object, 1));
  doubt.missing = double(pixels_in(missing)) * per_object;
  doubt.extra = double(pixels_in(extra)) * per_object;
  doubt.missing_area = missing;
  doubt.doubtful = std::move(missing);
  add_to(doubt.doubtful, extra);
  return doubt;
}

// More than half of the block; unknown where any of it is.
uint8_t block_of(const HullMask& m, int x0, int y0, int n) {
  int object = 0;
  for (int y = y0; y < y0 + n; ++y)
    for (int x = x0; x < x0 + n; ++x) {
      const uint8_t pixel = m.mask[size_t(y) * size_t(m.camera.width) + size_t(x)];
      if (pixel == kUnknown) return kUnknown;
      object += pixel == kObject;
    }
  return 2 * object > n * n ? kObject : kBackground;
}

// The median of the views of about the same focal length, or more where a larger view needs it.
std::vector<int> reductions_of(std::span<const HullMask> masks, int max_side) {
  std::vector<int> own, out;
  for (const HullMask& m : masks) own.push_back(reduction_of(m.camera.width, m.camera.height, max_side));
  for (size_t i = 0; i < masks.size(); ++i) {
    const Camera& c = masks[i].camera;
    std::vector<int> alike{own[i]};
    for (size_t k = 0; k < masks.size(); ++k)
      if (k != i && std::abs(masks[k].camera.fx / c.fx - 1) < kAlike) alike.push_back(own[k]);
    out.push_back(std::max(own[i], std::min({median(alike), c.width, c.height})));
  }
  return out;
}

void mark_outliers(std::vector<MaskDoubt>& doubts) {
  std::vector<double> missing, extra;
  for (const MaskDoubt& d : doubts) missing.push_back(d.missing), extra.push_back(d.extra);
  if (doubts.empty()) return;
  const double usual_missing = median(missing), usual_extra = median(extra);
  for (MaskDoubt& d : doubts)
    d.stands_out = d.missing > kShare + kOutlier * usual_missing || d.extra > kShare + kOutlier * usual_extra;
}

}  // namespace

std::vector<HullMask> SmallMasks::views() const {
  std::vector<HullMask> out;
  for (size_t i = 0; i < masks.size(); ++i) out.push_back({cameras[i], masks[i]});
  return out;
}

int reduction_of(int width, int height, int max_side) {
  return std::max(1, (std::max(width, height) + max_side - 1) / max_side);
}

SmallMasks small_masks(std::span<const HullMask> masks, const Normalization& normalization, int max_side) {
  SmallMasks out;
  out.cameras.resize(masks.size());
  out.masks.resize(masks.size());
  const std::vector<int> reductions = reductions_of(masks, max_side);
  parallel_for(int(masks.size()), [&](int i) {
    const HullMask& m = masks[size_t(i)];
    const int n = reductions[size_t(i)];
    const Camera small = scaled(normalization.unit_from_capture(m.camera), n);
    for (int y = 0; y < small.height; ++y)
      for (int x = 0; x < small.width; ++x) out.masks[size_t(i)].push_back(block_of(m, x * n, y * n, n));
    out.cameras[size_t(i)] = small;
  });
  return out;
}

std::vector<MaskDoubt> vote_on_masks(const SmallMasks& masks) {
  const std::vector<HullMask> views = masks.views();
  const Votes votes(views);
  std::vector<MaskDoubt> doubts(views.size());
  parallel_for(int(views.size()),
               [&](int i) { doubts[size_t(i)] = judge(votes, views[size_t(i)], size_t(i)); });
  mark_outliers(doubts);
  return doubts;
}

double share_of_object(const Area& area, std::span<const uint8_t> mask) {
  const auto object = std::count(mask.begin(), mask.end(), kObject);
  return double(pixels_in(area)) / double(std::max<std::ptrdiff_t>(object, 1));
}

Area enlarged(const Area& area, int small_width, int small_height, int width, int height) {
  const Area grown = dilated(area, small_width, small_height, 1);
  const int n = std::max(1, width / std::max(small_width, 1));
  Area out(size_t(width) * height);
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x)
      out[size_t(y) * width + x] =
          grown[size_t(std::min(y / n, small_height - 1)) * small_width + std::min(x / n, small_width - 1)];
  return out;
}

Area at_full_size(const Area& area, const Camera& small, const Camera& full) {
  return area.empty() ? Area() : enlarged(area, small.width, small.height, full.width, full.height);
}

}  // namespace cei3d
