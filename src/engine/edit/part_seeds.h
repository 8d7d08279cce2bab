// SPDX-License-Identifier: Apache-2.0
// Seeds on the handler points from the clicks or the mask of one view.
#pragma once

#include <span>
#include <vector>

#include "engine/edit/part.h"
#include "engine/segment/compete.h"

namespace cei3d {

// The surface that the request's view shows at the pixels: #pixels. Errors: a pixel outside the image or on
// the background.
std::vector<Hit> clicked_hits(const Device&, const Scene&, const PartRequest&, std::span<const Vec2f> pixels);

// Seeds from the request's mask, else from its clicks: #handlers. Errors: see select_part().
std::vector<Seed> part_seeds(const Device&, const Scene&, const PartRequest&);

}  // namespace cei3d
