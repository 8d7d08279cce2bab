// SPDX-License-Identifier: Apache-2.0
// How bright a photograph is against a render of the same things.
#pragma once

#include <optional>

#include "core/image/area.h"
#include "core/image/image.h"

namespace cei3d {

// The factors of the linear channels that make `shown` as bright as the photograph, over the pixels of the
// area that are neither clipped nor nearly black in either. Sums are compared, so that a blurred render will
// do. Images: of one size, display-encoded, at least 3 channels. None: too few such pixels.
std::optional<Vec3f> exposure_between(const Image& shown_srgb, const Image& photo_srgb, const Area&);

// The display-encoded image after its linear channels were multiplied; a fourth channel stays.
Image exposed(Image srgb, Vec3f factors);

}  // namespace cei3d
