// SPDX-License-Identifier: Apache-2.0
// Sizes of pictures.
#pragma once

#include "core/image/image.h"

namespace cei3d {

// Mean over n x n blocks; columns and rows that don't fill a block are cut off, as scaled(Camera, n) assumes.
// Values must be linear. With 4 channels, color is weighted by alpha (straight alpha in and out).
Image downscale(const Image& image, int n);

}  // namespace cei3d
