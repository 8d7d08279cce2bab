// SPDX-License-Identifier: Apache-2.0
#include "engine/capture/moved_areas.h"

#include "core/base/parallel.h"
#include "engine/capture/cell_votes.h"
#include "engine/capture/ray_votes.h"

namespace cei3d {
namespace {

constexpr double kWrong = 0.05;  // share of the voters
constexpr Cells kCells{96};      // find the pixels that have to be looked at
constexpr int kOpening = 2;      // pixels: outlines of few pixels' error do not count

// Views that show one state of the object.
struct State {
  std::vector<HullMask> views;
  Area cells;  // that nearly all of them show

  explicit State(std::vector<HullMask> v) : views(std::move(v)) {
    CellVotes votes(kCells, kWrong);
    for (const HullMask& view : views) votes.add(samples_of(view, kCells));
    cells = votes.supported_cells(MaskSample::nothing);
  }
};

// Where, among `asked`, the mask of another view does not agree with nearly all of them.
Area contradictions(const HullMask& view, const State& state, const Area& asked) {
  const int w = view.camera.width, h = view.camera.height;
  const RayVotes votes(state.views, view.camera);
  const size_t wrong = votes.allowed(kWrong);
  Area out(asked.size());
  for (int y = 0; y < h; ++y)
    for (int x = 0; x < w; ++x) {
      const size_t i = size_t(y) * size_t(w) + size_t(x);
      if (!asked[i] || view.mask[i] == kUnknown) continue;
      const bool shown = ray_meets_cells(view.camera, x, y, kCells, state.cells);
      if (view.mask[i] == kObject)
        out[i] = !shown && votes.against(x, y, wrong, wrong) > wrong;
      else
        out[i] = shown && votes.meets_object(x, y, wrong);
    }
  return opened(out, w, h, kOpening);
}

// Pieces of the object near the area that it cuts off from the rest: nothing but what may have moved holds
// them. None where all that the area leaves of the object is near it.
Area cut_off(const HullMask& view, const Area& area, const Area& around) {
  Area rest(area.size()), beyond(area.size());
  for (size_t i = 0; i < area.size(); ++i) {
    rest[i] = view.mask[i] == kObject && !area[i];
    beyond[i] = rest[i] && !around[i];
  }
  if (pixels_in(beyond) == 0) return beyond;
  const Area held = parts_with(beyond, rest, view.camera.width, view.camera.height);
  for (size_t i = 0; i < rest.size(); ++i) rest[i] = rest[i] && !held[i];
  return rest;
}

}  // namespace

std::vector<Area> moved_areas(const SmallMasks& masks, const MovedPart& part) {
  const std::vector<HullMask> views = masks.views();
  std::vector<HullMask> most;
  for (size_t v = 0; v < views.size(); ++v)
    if (part.shown_by_most(v)) most.push_back(views[v]);
  std::vector<Area> areas(views.size());
  const State state(std::move(most));
  parallel_for(int(views.size()), [&](int k) {
    const auto v = size_t(k);
    if (part.shown_by_most(v)) return;
    const Camera& camera = views[v].camera;
    const Area place = seen_hull(part.place, camera), around = seen_hull(part.around, camera);
    Area& area = areas[v];
    area = contradictions(views[v], state, around);
    add_to(area, place);
    area = parts_with(place, area, camera.width, camera.height);
    add_to(area, cut_off(views[v], area, around));
  });
  return areas;
}

}  // namespace cei3d
