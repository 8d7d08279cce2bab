// SPDX-License-Identifier: Apache-2.0
// Images scaled, cropped and turned.
#pragma once

#include "core/image/image.h"
#include "core/math/pixel_box.h"

namespace cei3d {

// Mean over n x n blocks of linear values. Columns and rows that do not fill a block are cut off, as in
// scaled(Camera, n). With 4 channels, color is weighted by alpha (straight alpha in and out);
// a block with a pixel of negative alpha, which is unknown, gets the alpha -1.
Image downscale(const Image& image, int n);

// Bilinear, at the centers of the new pixels.
Image scaled_to(const Image& image, int width, int height);

// The part of the image in a box within it.
Image cropped(const Image& image, const PixelBox& box);

// The image as it should be shown by its EXIF orientation, 5 to 8, which swaps its sides; others: as it is.
Image turned(Image image, int orientation);

}  // namespace cei3d
