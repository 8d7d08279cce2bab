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
  RayVotes on(size_t own) const { return {without(own), views[own].camera}; }
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

// What many of the other views look past.
struct Past {
  Area likely, sure;
};

Past look_past(const RayVotes& others, const HullMask& view, Area asked) {
  const int w = view.camera.width, h = view.camera.height;
  Past out{std::move(asked), Area(view.mask.size())};
  for (int y = 0; y < h; ++y)
    for (int x = 0; x < w; ++x) {
      const size_t i = size_t(y) * size_t(w) + size_t(x);
      if (!out.likely[i]) continue;
      const size_t against = others.against(x, y, others.allowed(kLikely), others.allowed(kSure));
      out.likely[i] = against > others.allowed(kLikely);
      out.sure[i] = against > others.allowed(kSure);
    }
  return out;
}

Area gap_of(const RayVotes& others, const HullMask& view, const Area& cells) {
  const int w = view.camera.width, h = view.camera.height;
  const Past past = look_past(others, view, unsupported(cells, view));
  return parts_with(opened(past.sure, w, h, kOpening), opened(past.likely, w, h, kOpening), w, h);
}

// The object's pixels beside the area, within `radius` pixels along both axes.
Area beside(const Area& area, const HullMask& view, int radius) {
  Area out = dilated(area, view.camera.width, view.camera.height, radius);
  for (size_t i = 0; i < out.size(); ++i) out[i] = out[i] && !area[i] && view.mask[i] == kObject;
  return out;
}

// Up to the object that the other views show, whose cells were not asked, and as far beyond as their outlines
// may be wrong.
void grow_to_outline(const RayVotes& others, const HullMask& view, Area& gap) {
  const int w = view.camera.width, h = view.camera.height;
  Area more = look_past(others, view, beside(gap, view, std::max(w, h) / kCells.n)).likely;
  add_to(more, gap);
  gap = parts_with(gap, more, w, h);
  add_to(gap, beside(gap, view, kOpening));
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
    gaps[v] = gap_of(votes.on(v), views[v], has_vote[v] ? of_voter : of_other);
    shares[v] = share_of_object(gaps[v], views[v].mask);
  });
  const double least = kShare + kOutlier * median(shares);
  parallel_for(int(views.size()), [&](int i) {
    const auto v = size_t(i);
    if (shares[v] > least)
      grow_to_outline(votes.on(v), views[v], gaps[v]);
    else
      gaps[v].clear();
  });
  return gaps;
}

}  // namespace cei3d
