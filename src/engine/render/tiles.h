// SPDX-License-Identifier: Apache-2.0
// A frame in tiles, so that it can be shown as it grows and given up between two of them. The tiles together
// are the whole frame, bit for bit.
#pragma once

#include <vector>

#include "core/math/pixel_box.h"
#include "engine/render/render_cache.h"

namespace cei3d {

// Boxes of at most side x side pixels that cover the image, those nearest to its middle first.
std::vector<PixelBox> tiles_of(int width, int height, int side);

// The part of a frame in the box. camera: unit frame. light: RenderCache::light() of the scene.
Frame render_tile(RenderCache&, const Scene&, const SceneLight& light, const Camera& camera, int samples,
                  const PixelBox& box);

// The pixels of the box, which lies within the frame.
Frame cropped(const Frame&, const PixelBox& box);

}  // namespace cei3d
