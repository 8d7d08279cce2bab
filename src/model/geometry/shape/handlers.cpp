// SPDX-License-Identifier: Apache-2.0
#include "model/geometry/shape/handlers.h"

#include <bit>

#include "model/geometry/shape/point_index.h"

namespace cei3d {
namespace {

// The kept points in a growing hash grid: one chain of points per bucket.
class Thinning {
 public:
  Thinning(float spacing, size_t n_hits)
      : spacing_(spacing), head_(std::bit_ceil(std::max<size_t>(n_hits / 8, 64)), -1) {
    kept.spacing = spacing;
  }

  // Index of a kept point within the spacing of the hit and on its side of the surface; -1: none.
  int neighbor(const Hit& hit) const {
    const GridIndex home = GridIndex::of(hit.position, spacing_);
    for (const GridIndex& d : kCellNeighbors) {
      const GridIndex c{home.x + d.x, home.y + d.y, home.z + d.z};
      for (int i = head_[bucket(c)]; i >= 0; i = next_[i]) {
        const Vec3f to_point = kept.positions[i] - hit.position;
        if (dot(to_point, to_point) < spacing_ * spacing_ && dot(kept.normals[i], hit.normal) > 0) return i;
      }
    }
    return -1;
  }

  void add(const Hit& hit, float footprint) {
    const uint32_t b = bucket(GridIndex::of(hit.position, spacing_));
    next_.push_back(head_[b]);
    head_[b] = int(kept.positions.size());
    kept.positions.push_back(hit.position);
    kept.normals.push_back(hit.normal);
    kept.footprints.push_back(footprint);
  }

  HandlerPoints kept;

 private:
  uint32_t bucket(GridIndex c) const { return c.hash() & uint32_t(head_.size() - 1); }
  float spacing_;
  std::vector<int> head_, next_;  // first kept point of a bucket; the one after each
};

}  // namespace

HandlerPoints thin_hits(std::span<const Hit> hits, std::span<const float> footprints, float spacing) {
  Thinning thinning(spacing, hits.size());
  for (size_t i = 0; i < hits.size(); ++i) {
    const int near = thinning.neighbor(hits[i]);
    if (near < 0) {
      thinning.add(hits[i], footprints[i]);
    } else {
      float& best = thinning.kept.footprints[near];
      best = min(best, footprints[i]);
    }
  }
  return std::move(thinning.kept);
}

}  // namespace cei3d
