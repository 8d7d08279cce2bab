// SPDX-License-Identifier: Apache-2.0
// Pixels at an edge behind which another part of the object, or the background, is seen.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "engine/reconstruct/pixels.h"
#include "model/geometry/shape/hit.h"

namespace cei3d {

class Surface;

// #hits, 1: a ray one pixel beside that of the hit misses the surface or meets it at another depth. A pixel's
// color is a mean over about that area (as in render.h), so it is of two surfaces; and where the edge of the
// reconstructed surface is off by less than a pixel, it is of the wrong one.
// hits: on the surface; pixel_of: #hits, index into PixelStore::pixels().
std::vector<uint8_t> on_edges(const Surface&, const PixelStore&, std::span<const Hit> hits,
                              std::span<const size_t> pixel_of);

}  // namespace cei3d
