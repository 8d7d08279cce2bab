// SPDX-License-Identifier: Apache-2.0
// Sets of pixels as byte masks: [height][width], 1 inside.
#pragma once

#include <cstdint>
#include <vector>

#include "core/image/image.h"

namespace cei3d {

using Area = std::vector<uint8_t>;

// The area grown by `radius` pixels along both axes (by a square).
Area dilated(const Area& area, int width, int height, int radius);

// The area without the pixels that have one outside of the area within `radius` pixels along both axes. What
// is beyond the border of the image counts as inside.
Area eroded(const Area& area, int width, int height, int radius);

// Eroded, then dilated: the area without its parts that are narrower than 2 radius + 1 pixels.
Area opened(const Area& area, int width, int height, int radius);

// The parts of the area, connected along the axes, that hold a pixel of `seeds`.
Area parts_with(const Area& seeds, const Area& area, int width, int height);

// The image with all channels set to `background` outside the area.
Image shown_in(const Image& image, const Area& area, float background);

// Adds the pixels of `more` to the area.
void add_to(Area& area, const Area& more);

// Number of pixels in the area.
size_t pixels_in(const Area& area);

}  // namespace cei3d
