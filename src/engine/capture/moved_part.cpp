// SPDX-License-Identifier: Apache-2.0
#include "engine/capture/moved_part.h"

#include <algorithm>
#include <map>
#include <numeric>

#include "core/base/parallel.h"
#include "engine/capture/cell_votes.h"
#include "model/geometry/unwrap/outline.h"

namespace cei3d {
namespace {

using Views = std::span<const HullMask>;

constexpr Cells kCells{64};
// Share of the other views that may see background in a cell of the object.
constexpr double kTolerance = 0.05;
constexpr int kOpening = 1;      // pixels: differences along a thin outline do not count
constexpr size_t kMinViews = 8;  // before the move, and after it
constexpr size_t kTried = 12;    // cuts, to begin with
// Mean share of the object's pixels that the views on the other side of the move do not support, at least;
// and what those on the same side do not support, as a share of that, at most.
constexpr double kMoved = 0.001, kWithin = 0.2;
constexpr double kBeyond = 0.2;  // share of the views that show a moved cell beside the other position
constexpr size_t kMinCells = 4;
constexpr double kPlace = 1, kAround = 6;  // cells on each side of a moved one

// Object pixels among `asked` of a view that the views of the votes do not support. own: object if it is one
// of these views.
Area unsupported(const CellVotes& votes, const HullMask& view, MaskSample own, const Area& asked) {
  const int w = view.camera.width, h = view.camera.height;
  Area out(view.mask.size());
  for (int y = 0; y < h; ++y)
    for (int x = 0; x < w; ++x)
      if (const size_t i = size_t(y) * size_t(w) + size_t(x); asked[i] && view.mask[i] == kObject)
        out[i] = !ray_meets(view.camera, x, y, kCells, [&](Vec3d p) { return votes.supported(p, own); });
  return opened(out, w, h, kOpening);
}

std::vector<Area> unsupported(const CellVotes& votes, Views views, MaskSample own,
                              std::span<const Area> asked) {
  std::vector<Area> areas(views.size());
  parallel_for(int(views.size()), [&](int i) {
    areas[size_t(i)] = unsupported(votes, views[size_t(i)], own, asked[size_t(i)]);
  });
  return areas;
}

std::vector<Area> everywhere(Views views) {
  std::vector<Area> out;
  for (const HullMask& view : views) out.emplace_back(view.mask.size(), uint8_t(1));
  return out;
}

// What the views show in the cells. #views
using Samples = std::span<const std::vector<MaskSample>>;

CellVotes votes_of(Samples samples) {
  CellVotes votes(kCells, kTolerance);
  for (const std::vector<MaskSample>& of_view : samples) votes.add(of_view);
  return votes;
}

// For each view, the share of its object's pixels that are in the area.
std::vector<double> shares(Views views, std::span<const Area> areas) {
  std::vector<double> out;
  for (size_t i = 0; i < views.size(); ++i) out.push_back(share_of_object(areas[i], views[i].mask));
  return out;
}

double sum(std::span<const double> values) { return std::accumulate(values.begin(), values.end(), 0.0); }

// Two groups of views: those before a cut, and those from it on.
struct Groups {
  Views before, after;
  CellVotes of_before, of_after;
  Groups(Views views, Samples samples, size_t cut)
      : before(views.first(cut)),
        after(views.subspan(cut)),
        of_before(votes_of(samples.first(cut))),
        of_after(votes_of(samples.subspan(cut))) {}
};

// Sum over the views of what their own groups do not support.
double within_groups(Views views, Samples samples, size_t cut, std::span<const Area> asked) {
  const Groups g(views, samples, cut);
  const auto of = [](Views v, const CellVotes& votes, std::span<const Area> a) {
    return sum(shares(v, unsupported(votes, v, MaskSample::object, a)));
  };
  return of(g.before, g.of_before, asked.first(cut)) + of(g.after, g.of_after, asked.subspan(cut));
}

// The cut for which that is smallest, by ever smaller steps around the best one so far.
size_t best_cut(Views views, Samples samples, std::span<const Area> asked) {
  std::map<size_t, double> tried;
  const size_t last = views.size() - kMinViews;
  const auto attempt = [&](size_t cut) {
    if (cut >= kMinViews && cut <= last && !tried.contains(cut))
      tried[cut] = within_groups(views, samples, cut, asked);
  };
  const auto best = [&] {
    return std::min_element(tried.begin(), tried.end(),
                            [](const auto& a, const auto& b) { return a.second < b.second; })
        ->first;
  };
  size_t step = std::max<size_t>(1, views.size() / kTried);
  for (size_t cut = kMinViews; cut <= last; cut += step) attempt(cut);
  while (step > 1) {
    step = (step + 1) / 2;
    const size_t at = best();
    attempt(at - step), attempt(at + step);
  }
  return best();
}

// What each group does not support, of every view.
struct Doubts {
  std::vector<double> of_before, of_after;
  double across(size_t cut) const {
    return sum(std::span(of_after).first(cut)) + sum(std::span(of_before).subspan(cut));
  }
  double within(size_t cut) const {
    return sum(std::span(of_before).first(cut)) + sum(std::span(of_after).subspan(cut));
  }
};

Doubts doubts_of(Views views, const Groups& g) {
  const std::vector<Area> all = everywhere(views);
  const size_t cut = g.before.size();
  const auto of = [&](const CellVotes& votes, bool before) {
    std::vector<Area> areas(views.size());
    parallel_for(int(views.size()), [&](int i) {
      const bool own = (size_t(i) < cut) == before;
      areas[size_t(i)] = unsupported(votes, views[size_t(i)], own ? MaskSample::object : MaskSample::nothing,
                                     all[size_t(i)]);
    });
    return shares(views, areas);
  };
  return {of(g.of_before, true), of(g.of_after, false)};
}

// The best cut if the groups stay as they are: a group that is large enough tolerates a view of the other.
size_t adjusted(const Doubts& doubts, size_t cut) {
  size_t best = cut;
  for (size_t c = kMinViews; c + kMinViews <= doubts.of_before.size(); ++c)
    if (doubts.within(c) < doubts.within(best)) best = c;
  return best;
}

// Centers of the cells of the object, by its own votes, that many of the views show beside what the other
// votes take for the object.
std::vector<Vec3d> moved_cells(Views views, const CellVotes& own, const CellVotes& other) {
  const std::vector<Area> beside = unsupported(other, views, MaskSample::nothing, everywhere(views));
  std::vector<Vec3d> cells;
  for (size_t cell = 0; cell < kCells.count(); ++cell) {
    const Vec3d p = kCells.center(cell);
    if (!own.supported(p, MaskSample::nothing) || other.supported(p, MaskSample::nothing)) continue;
    int seen = 0, beyond = 0;
    for (size_t v = 0; v < views.size(); ++v) {
      if (sample_mask(views[v], p) == MaskSample::nothing) continue;
      const Vec3d at = views[v].camera.project(p);
      ++seen;
      beyond += beside[v][size_t(at.y) * size_t(views[v].camera.width) + size_t(at.x)];
    }
    if (beyond > kBeyond * seen) cells.push_back(p);
  }
  return cells;
}

// Corners of cubes around their centers. half: of an edge, in cells.
std::vector<Vec3d> corners_around(std::span<const Vec3d> cells, double half) {
  std::vector<Vec3d> out;
  for (const Vec3d p : cells)
    for (const double x : {-1.0, 1.0})
      for (const double y : {-1.0, 1.0})
        for (const double z : {-1.0, 1.0}) out.push_back(p + Vec3d{x, y, z} * (half * 2.0 / kCells.n));
  return out;
}

}  // namespace

// A pixel is in the hull if its center is to the left of each of its edges.
Area seen_hull(std::span<const Vec3d> points, const Camera& camera) {
  std::vector<Vec2d> seen;
  for (const Vec3d p : points)
    if (const Vec3d at = camera.project(p); at.z > 0) seen.push_back({at.x, at.y});
  const std::vector<Vec2d> outline = convex_hull(std::move(seen));
  Area out(size_t(camera.width) * size_t(camera.height));
  if (outline.size() < 3) return out;
  const auto inside = [&](Vec2d p) {
    for (size_t k = 0; k < outline.size(); ++k) {
      const Vec2d from = outline[k], to = outline[(k + 1) % outline.size()];
      if (signed_area(to - from, p - from) < 0) return false;
    }
    return true;
  };
  for (int y = 0; y < camera.height; ++y)
    for (int x = 0; x < camera.width; ++x)
      out[size_t(y) * size_t(camera.width) + size_t(x)] = inside({x + 0.5, y + 0.5});
  return out;
}

std::optional<MovedPart> find_moved_part(const SmallMasks& masks) {
  const std::vector<HullMask> all = masks.views();
  const Views views(all);
  if (views.size() < 2 * kMinViews) return {};
  std::vector<std::vector<MaskSample>> samples;
  for (const HullMask& view : views) samples.push_back(samples_of(view, kCells));
  const double least = kMoved * double(views.size());
  const std::vector<Area> doubtful =
      unsupported(votes_of(samples), views, MaskSample::object, everywhere(views));
  if (sum(shares(views, doubtful)) < least) return {};
  const size_t found = best_cut(views, samples, doubtful);
  const Doubts doubts = doubts_of(views, Groups(views, samples, found));
  const size_t cut = adjusted(doubts, found);
  if (doubts.across(cut) < least || doubts.within(cut) > kWithin * doubts.across(cut)) return {};
  const Groups g(views, samples, cut);
  std::vector<Vec3d> cells = moved_cells(g.before, g.of_before, g.of_after);
  for (const Vec3d p : moved_cells(g.after, g.of_after, g.of_before)) cells.push_back(p);
  if (cells.size() < kMinCells) return {};
  return MovedPart{cut, 2 * cut >= views.size(), corners_around(cells, kPlace),
                   corners_around(cells, kAround)};
}

}  // namespace cei3d
