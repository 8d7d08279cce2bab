// SPDX-License-Identifier: Apache-2.0
#include "model/geometry/visual_hull.h"

#include <cmath>

#include "core/base/error.h"
#include "core/base/parallel.h"

namespace cei3d {

namespace {

enum class Vote { unseen, object, background };

Vote look(const HullMask& view, Vec3d p) {
  const Vec3d q = view.camera.project(p);
  if (q.z <= 0) return Vote::unseen;
  const double x = std::floor(q.x), y = std::floor(q.y);
  if (!(x >= 0 && y >= 0 && x < view.camera.width && y < view.camera.height)) return Vote::unseen;
  return view.mask[size_t(y) * view.camera.width + size_t(x)] ? Vote::object : Vote::background;
}

bool is_inside(std::span<const HullMask> views, Vec3d p, int tolerated, int min_seen) {
  int against = 0, seen = 0;
  for (const HullMask& view : views) {
    const Vote vote = look(view, p);
    seen += vote != Vote::unseen;
    against += vote == Vote::background;
    if (against > tolerated) return false;
  }
  return seen > against && seen >= min_seen;
}

}  // namespace

VisualHull visual_hull(std::span<const HullMask> views, int n, Vec3f lo, Vec3f hi, int tolerated,
                       int min_seen) {
  for (const HullMask& view : views)
    if (view.mask.size() != size_t(view.camera.width) * view.camera.height)
      fail("A mask of {} pixels does not fit a camera of {} x {}.", view.mask.size(), view.camera.width, view.camera.height);
  VisualHull hull{n, lo, hi, std::vector<uint8_t>(size_t(n) * n * n, 0)};
  const Vec3d size = to_double(hi - lo) / double(n);
  parallel_for(n, [&](int z) {
    for (int y = 0; y < n; ++y)
      for (int x = 0; x < n; ++x)
        hull.inside[(size_t(z) * n + y) * n + x] =
            is_inside(views, to_double(lo) + size * Vec3d{x + 0.5, y + 0.5, z + 0.5}, tolerated, min_seen);
  });
  return hull;
}

}  // namespace cei3d
