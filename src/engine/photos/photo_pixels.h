// SPDX-License-Identifier: Apache-2.0
// Pixels of a photograph as its file has them, before any lens is undone.
#pragma once

#include <optional>
#include <vector>

#include "core/image/image.h"
#include "core/math/pixel_box.h"
#include "core/math/vec2.h"
#include "model/scene/view.h"

namespace cei3d {

PixelBox whole(const View&);  // all of the photograph

// Around the pixels and wider by a share of its longer side, within the limit. Width 0: there are none.
PixelBox box_around(const std::vector<Vec2f>& pixels, double margin, const PixelBox& limit);

// Where the photograph shows a point; none: it does not.
std::optional<Vec2d> photo_pixel(const View&, Vec3d point);

// A mask of the photograph's size, 1 where the log-odds of that section are positive.
Image mask_image(const Image& log_odds, const PixelBox& section, const View&);

}  // namespace cei3d
