// SPDX-License-Identifier: Apache-2.0
// Seeds on the handler points from the clicks, strokes or mask of one view.
#pragma once

#include <span>
#include <vector>

#include "engine/edit/part.h"
#include "engine/segment/compete.h"

namespace cei3d {

// The surface that the request's view shows at the pixels: #pixels. Errors: a pixel outside the image or on
// the background.
std::vector<Hit> clicked_hits(const Device&, const Scene&, const PartRequest&, std::span<const Vec2f> pixels);

// Seeds from the request's mask, else from its strokes and clicks: #handlers. Errors: see select_part().
std::vector<Seed> part_seeds(const Device&, const Scene&, const PartRequest&);

// Centers of the pixels drawn in a mask (1 channel) of the request's view that show the object at a cosine to
// the camera above 0.1; of many pixels an even selection.
std::vector<Vec2f> drawn_on_object(const Device&, const Scene&, const PartRequest&, const Image& mask);

// A few prompts for a network: the clicks, and points spread over the strokes.
Prompts network_prompts(const Device&, const Scene&, const PartRequest&);

}  // namespace cei3d
