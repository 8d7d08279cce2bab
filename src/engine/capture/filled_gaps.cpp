// SPDX-License-Identifier: Apache-2.0
#include "engine/capture/filled_gaps.h"

#include <algorithm>

#include "core/base/parallel.h"
#include "core/math/quantile.h"
#include "engine/capture/cell_votes.h"

namespace cei3d {
namespace {

using Views = std::span<const HullMask>;

// A gap holds places of the image where more than kSure of the other views look past the object, and around
// them those where more than kLikely do. At least one other view may always be wrong.
constexpr double kLikely = 0.02, kSure = 0.05;
constexpr Cells kCells{96};       // find the pixels that have to be looked at
constexpr Cells kSteps{192};      // along their rays
constexpr int kOpening = 2;       // pixels: what is narrower is an outline drawn too wide
constexpr double kShare = 0.002,  // of the object's pixels
    kOutlier = 3;                 // a mask stands out: share > kShare + kOutlier x median

// The cells that nearly all views show, without the one that asks, which shows the object.
Area supported_cells(Views views) {
  CellVotes votes(kCells, kLikely);
  for (const HullMask& view : views) votes.add(samples_of(view, kCells));
  Area out(kCells.count());
  for (size_t i = 0; i < out.size(); ++i) out[i] = votes.supported(kCells.center(i), MaskSample::object);
  return out;
}

// Object pixels whose rays meet none of the cells; of each four pixels one is asked.
Area unsupported(const Area& cells, const HullMask& view) {
  const int w = view.camera.width, h = view.camera.height;
  Area out(view.mask.size());
  const auto in_cell = [&](Vec3d p) {
    const int cell = kCells.at(p);
    return cell >= 0 && cells[size_t(cell)];
  };
  const auto at = [&](int x, int y) { return size_t(y) * size_t(w) + size_t(x); };
  for (int y = 0; y < h; ++y)
    for (int x = 0; x < w; ++x) {
      const size_t asked = at(x & ~1, y & ~1), i = at(x, y);
      if (view.mask[i] == kObject && view.mask[asked] == kObject)
        out[i] = asked == i ? !ray_meets(view.camera, x, y, kCells, in_cell) : out[asked];
    }
  return opened(out, w, h, kOpening);
}

// What the other views say about the ray of a pixel.
class OtherViews {
 public:
  OtherViews(Views views, size_t own) : views_(views), own_(own) {}

  size_t allowed(double share) const {
    return std::max(size_t(1), size_t(share * double(views_.size() - 1)));
  }
  // How many show background at the place of the ray where fewest do; `least` if these are as few, and one
  // more than `most` if they are more.
  size_t against(int x, int y, size_t least, size_t most) const {
    size_t fewest = most + 1;
    ray_meets(views_[own_].camera, x, y, kSteps, [&](Vec3d p) {
      fewest = std::min(fewest, against(p, fewest));
      return fewest <= least;
    });
    return std::max(fewest, least);
  }

 private:
  // How many show background at p, or `most`, if that is less. Of the few views that see a remote place, a
  // quarter suffices to rule the object out.
  size_t against(Vec3d p, size_t most) const {
    size_t n = 0, seen = 0;
    for (size_t v = 0; v < views_.size() && n < most; ++v) {
      if (v == own_) continue;
      const MaskSample s = sample_mask(views_[v], p);
      seen += s != MaskSample::nothing;
      n += s == MaskSample::background;
    }
    const bool few = 3 * seen < views_.size();
    return few && 4 * n > seen ? most : n;
  }

  Views views_;
  size_t own_;
};

Area gap_of(Views views, size_t index, const Area& cells) {
  const HullMask& view = views[index];
  const int w = view.camera.width, h = view.camera.height;
  const OtherViews others(views, index);
  Area likely = unsupported(cells, view), sure(likely.size());
  for (int y = 0; y < h; ++y)
    for (int x = 0; x < w; ++x) {
      const size_t i = size_t(y) * size_t(w) + size_t(x);
      if (!likely[i]) continue;
      const size_t against = others.against(x, y, others.allowed(kLikely), others.allowed(kSure));
      likely[i] = against > others.allowed(kLikely);
      sure[i] = against > others.allowed(kSure);
    }
  return parts_with(opened(sure, w, h, kOpening), opened(likely, w, h, kOpening), w, h);
}

}  // namespace

std::vector<Area> filled_gaps(const SmallMasks& masks) {
  const std::vector<HullMask> views = masks.views();
  if (views.empty()) return {};
  const Area cells = supported_cells(views);
  std::vector<Area> gaps(views.size());
  std::vector<double> shares(views.size());
  parallel_for(int(views.size()), [&](int v) {
    gaps[size_t(v)] = gap_of(views, size_t(v), cells);
    shares[size_t(v)] = share_of_object(gaps[size_t(v)], views[size_t(v)].mask);
  });
  const double usual = median(shares);
  for (size_t v = 0; v < views.size(); ++v)
    if (shares[v] <= kShare + kOutlier * usual) gaps[v].clear();
  return gaps;
}

}  // namespace cei3d
