// SPDX-License-Identifier: Apache-2.0
// What a model shows from a camera.
#pragma once

#include "core/image/image.h"

namespace cei3d {

struct ModelView {
  Image srgb;   // RGB over white
  Image depth;  // along the ray of each pixel's center, in world units; 0: nothing is there
};

}  // namespace cei3d
