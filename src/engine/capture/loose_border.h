// SPDX-License-Identifier: Apache-2.0
// Background along the outline of a mask that is drawn too wide, found by the colors of the photograph.
// docs/method.md#masks-that-are-a-little-wrong
#pragma once

#include "core/image/area.h"
#include "core/image/image.h"
#include "model/geometry/shape/visual_hull.h"

namespace cei3d {

// photograph: RGBA, linear, with the background that was photographed; mask: of its size. Both should have at
// most some hundred pixels a side. Returns the object pixels whose colors continue those of the background.
Area loose_border(const Image& photograph, const HullMask& mask);

}  // namespace cei3d
