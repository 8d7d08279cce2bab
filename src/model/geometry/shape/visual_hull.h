// SPDX-License-Identifier: Apache-2.0
// The visual hull: the part of space that all silhouettes allow. [Laurentini 1994]
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "core/math/camera.h"

namespace cei3d {

// What a pixel of a mask says. Unknown pixels have no vote.
inline constexpr uint8_t kBackground = 0, kObject = 1, kUnknown = 2;

struct HullMask {
  Camera camera;
  std::span<const uint8_t> mask;  // [camera.height][camera.width]: kBackground, kObject or kUnknown
};

struct VisualHull {
  int n = 0;  // cells per axis
  Vec3f lo{-1, -1, -1}, hi{1, 1, 1};
  std::vector<uint8_t> inside;  // [z][y][x], 1 where the cell's center is inside
};

// A cell is inside when at least `min_seen` views have it in their frame and all of those show the object
// there, except for `tolerated` views (mask errors). Uses all threads. Error: a mask of another size than its
// camera.
VisualHull visual_hull(std::span<const HullMask> views, int n, Vec3f lo = {-1, -1, -1}, Vec3f hi = {1, 1, 1},
                       int tolerated = 0, int min_seen = 1);

}  // namespace cei3d
