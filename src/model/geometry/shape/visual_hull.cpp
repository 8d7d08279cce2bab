// SPDX-License-Identifier: Apache-2.0
#include "model/geometry/shape/visual_hull.h"

#include "core/base/error.h"
#include "core/base/parallel.h"

namespace cei3d {

namespace {

// A view as projection matrix: (u z, v z, z) = rows . (p, 1).
struct Projection {
  Vec3d row[3];
  double offset[3];
  int width, height;
  const uint8_t* mask;
};

Projection projection_of(const HullMask& view) {
  const Camera& c = view.camera;
  const Mat3d r = transpose(c.world_from_cam);
  Projection p{
      {r.row[0] * c.fx + r.row[1] * c.skew + r.row[2] * c.cx, r.row[1] * c.fy + r.row[2] * c.cy, r.row[2]},
      {},
      c.width,
      c.height,
      view.mask.data()};
  for (int i = 0; i < 3; ++i) p.offset[i] = -dot(p.row[i], c.center);
  return p;
}

enum class Vote { unseen, object, background };

Vote look(const Projection& view, Vec3d p) {
  const double z = dot(view.row[2], p) + view.offset[2];
  if (!(z > 0)) return Vote::unseen;
  const double x = (dot(view.row[0], p) + view.offset[0]) / z, y = (dot(view.row[1], p) + view.offset[1]) / z;
  if (!(x >= 0 && y >= 0 && x < view.width && y < view.height)) return Vote::unseen;
  const uint8_t pixel = view.mask[size_t(y) * size_t(view.width) + size_t(x)];
  return pixel == kUnknown ? Vote::unseen : pixel == kBackground ? Vote::background : Vote::object;
}

bool is_inside(const std::vector<Projection>& views, Vec3d p, int tolerated, int min_seen) {
  int against = 0, seen = 0;
  for (const Projection& view : views) {
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
      fail("A mask of {} pixels does not fit a camera of {} x {}.", view.mask.size(), view.camera.width,
           view.camera.height);
  std::vector<Projection> projections;
  for (const HullMask& view : views) projections.push_back(projection_of(view));
  VisualHull hull{n, lo, hi, std::vector<uint8_t>(size_t(n) * n * n, 0)};
  const Vec3d size = to_double(hi - lo) / double(n);
  parallel_for(n, [&](int z) {
    for (int y = 0; y < n; ++y)
      for (int x = 0; x < n; ++x)
        hull.inside[(size_t(z) * n + y) * n + x] = is_inside(
            projections, to_double(lo) + size * Vec3d{x + 0.5, y + 0.5, z + 0.5}, tolerated, min_seen);
  });
  return hull;
}

}  // namespace cei3d
