// SPDX-License-Identifier: Apache-2.0
// Downscaling of images.
#pragma once

#include "core/image/image.h"

namespace cei3d {

// Mean over n x n blocks of linear values. Columns and rows that do not fill a block are cut off, as in
// scaled(Camera, n). With 4 channels, color is weighted by alpha (straight alpha in and out).
Image downscale(const Image& image, int n);

}  // namespace cei3d
