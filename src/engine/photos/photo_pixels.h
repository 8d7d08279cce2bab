// SPDX-License-Identifier: Apache-2.0
// Pixels of a photograph as its file has them, before any lens is undone.
#pragma once

#include <optional>

#include "core/image/image.h"
#include "core/math/pixel_box.h"
#include "core/math/vec2.h"
#include "model/scene/view.h"

namespace cei3d {

PixelBox whole(const View&);  // all of the photograph

// Where the photograph shows a point; none: it does not.
std::optional<Vec2d> photo_pixel(const View&, Vec3d point);

// A mask of the photograph's size, 1 where the log-odds of that section are positive.
Image mask_image(const Image& log_odds, const PixelBox& section, const View&);

}  // namespace cei3d
