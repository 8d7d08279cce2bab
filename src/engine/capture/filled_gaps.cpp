// SPDX-License-Identifier: Apache-2.0
#include "engine/capture/filled_gaps.h"

#include <algorithm>

#include "core/base/parallel.h"
#include "core/math/quantile.h"
#include "engine/capture/cell_votes.h"
#include "engine/capture/ray_votes.h"

namespace cei3d {
namespace {

using Views = std::span<const HullMask>;

// A gap holds places of the image where more than kSure of the other views look past the object, and around
// them those where more than kLikely do.
constexpr double kLikely = 0.02, kSure = 0.05;
constexpr Cells kCells{96};       // find the pixels that have to be looked at
constexpr int kOpening = 2;       // pixels: what is narrower is an outline drawn too wide
constexpr double kShare = 0.002,  // of the object's pixels
    kOutlier = 3;                 // a mask stands out: share > kShare + kOutlier x median

// Masks, of which some have a vote.
struct Votes {
  Views views;
  std::span<const uint8_t> has_vote;

  std::vector<HullMask> without(size_t own) const {
    std::vector<HullMask> out;
    for (size_t v = 0; v < views.size(); ++v)
      if (has_vote[v] && v != own) out.push_back(views[v]);
    return out;
  }
};

// Object pixels whose rays meet none of the cells; of each four pixels one is asked.
Area unsupported(const Area& cells, const HullMask& view) {
  const int w = view.camera.width, h = view.camera.height;
  Area out(view.mask.size());
  const auto at = [&](int x, int y) { return size_t(y) * size_t(w) + size_t(x); };
  for (int y = 0; y < h; ++y)
    for (int x = 0; x < w; ++x) {
      const size_t asked = at(x & ~1, y & ~1), i = at(x, y);
      if (view.mask[i] == kObject && view.mask[asked] == kObject)
        out[i] = asked == i ? !ray_meets_cells(view.camera, x, y, kCells, cells) : out[asked];
    }
  return opened(out, w, h, kOpening);
}

Area gap_of(const Votes& votes, size_t index, const Area& cells) {
  const HullMask& view = votes.views[index];
  const int w = view.camera.width, h = view.camera.height;
  const RayVotes others(votes.without(index), view.camera);
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

std::vector<Area> filled_gaps(const SmallMasks& masks, std::span<const uint8_t> has_vote) {
  const std::vector<HullMask> views = masks.views();
  if (views.empty()) return {};
  const Votes votes{views, has_vote};
  CellVotes cell_votes(kCells, kLikely);
  for (const HullMask& view : votes.without(views.size())) cell_votes.add(samples_of(view, kCells));
  const Area of_voter = cell_votes.supported_cells(MaskSample::object),
             of_other = cell_votes.supported_cells(MaskSample::nothing);
  std::vector<Area> gaps(views.size());
  std::vector<double> shares(views.size());
  parallel_for(int(views.size()), [&](int i) {
    const auto v = size_t(i);
    gaps[v] = gap_of(votes, v, has_vote[v] ? of_voter : of_other);
    shares[v] = share_of_object(gaps[v], views[v].mask);
  });
  const double usual = median(shares);
  for (size_t v = 0; v < views.size(); ++v)
    if (shares[v] <= kShare + kOutlier * usual) gaps[v].clear();
  return gaps;
}

}  // namespace cei3d
