// SPDX-License-Identifier: Apache-2.0
// Pixels at an edge behind which another part of the object, or the background, is seen.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "core/math/camera.h"
#include "model/geometry/shape/hit.h"

namespace cei3d {

class Surface;

// Which pixel of which view shows a hit.
struct SeenAt {
  uint16_t view, x, y;
};

// #hits, 1: a ray one pixel beside that of the hit misses the surface or meets it at another depth. A pixel's
// color is a mean over about that area (as in render.h), so it is of two surfaces; and where the edge of the
// reconstructed surface is off by less than a pixel, it is of the wrong one.
// cameras: of the views, unit frame. hits: on the surface; seen: #hits.
std::vector<uint8_t> on_edges(const Surface&, std::span<const Camera> cameras, std::span<const Hit> hits,
                              std::span<const SeenAt> seen);

}  // namespace cei3d
