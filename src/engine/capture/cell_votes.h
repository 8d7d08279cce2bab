// SPDX-License-Identifier: Apache-2.0
// What the masks of several views say about places of the unit frame.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "core/image/area.h"
#include "core/math/ray_sphere.h"
#include "model/geometry/shape/visual_hull.h"

namespace cei3d {

enum class MaskSample : uint8_t { nothing, background, object };
// What a view shows at p. Nothing: p is outside its frame, or its mask does not say.
MaskSample sample_mask(const HullMask& view, Vec3d p);

// A grid of cubes over [-1, 1]^3.
struct Cells {
  int n = 0;  // per axis
  size_t count() const { return size_t(n) * size_t(n) * size_t(n); }
  Vec3d center(size_t cell) const;
  int at(Vec3d p) const;  // the cell that holds p; -1: none does
};

// What a view shows at the centers of the cells. #cells
std::vector<MaskSample> samples_of(const HullMask& view, const Cells& cells);

// How many views see the center of each cell, and how many of these see background there.
class CellVotes {
 public:
  // tolerance: share of the views that may see background in a cell of the object.
  CellVotes(const Cells& cells, double tolerance);
  void add(std::span<const MaskSample> samples);  // of another view

  // Whether nearly all views show the object at p. own: what the view that asks shows there, which does not
  // count; nothing if it is not one of the views.
  bool supported(Vec3d p, MaskSample own) const;
  // The same for all cells. #cells
  Area supported_cells(MaskSample own) const;

 private:
  Cells cells_;
  double tolerance_;
  int views_ = 0;
  std::vector<uint16_t> seen_, against_;
};

// Whether the ray of a pixel meets a place for which object_at(Vec3d) holds, in steps of half a cell.
template <class F>
bool ray_meets(const Camera& camera, int x, int y, const Cells& cells, const F& object_at) {
  const Ray ray = camera.ray(x + 0.5, y + 0.5);
  const Vec3d origin = to_double(ray.origin), direction = to_double(ray.direction);
  const auto [first, last] = sphere_span(origin, direction, 1.0);
  for (double t = first; t < last; t += 1.0 / cells.n)
    if (object_at(origin + direction * t)) return true;
  return false;
}

// The same for places in the cells of an area.
bool ray_meets_cells(const Camera& camera, int x, int y, const Cells& cells, const Area& area);

}  // namespace cei3d
