// SPDX-License-Identifier: Apache-2.0
// From photographs taken through a lens to the pinhole views that everything else works with.
#pragma once

#include <optional>

#include "core/image/image.h"
#include "model/scene/view.h"

namespace cei3d {

// Columns and rows of a photograph, the last ones excluded.
struct PhotoBox {
  int x0 = 0, y0 = 0, x1 = 0, y1 = 0;
};

// A pinhole camera of the photograph's pose and focal length that shows the box and a few pixels around it.
// Its size is never that of the photograph, so that the size of an image tells which of the two it belongs
// to. Errors: it would need a field of view beyond 120 degrees, or more than twice the photograph's pixels
// along an axis.
Camera pinhole_around(const PhotoCamera& photo, const PhotoBox& box, const std::string& name);

// The photograph as the pinhole camera sees it. image: of the photograph's size, linear; with 4 channels
// straight alpha. Bicubic, colors weighted by alpha. Where the photograph shows nothing, alpha (with 4
// channels) or the value (with 1) is kUnknownAlpha.
Image undistorted(const Image& image, const PhotoCamera& photo, const Camera& pinhole);

// What a user drew on the photograph, as the view sees it; an image that is not of the photograph's size is
// returned as it is. Straight alpha, bilinear.
Image drawn_on_view(const View& view, Image drawing);

// A position on the photograph, or on an image of it, as a position on the view. Usage error: the lens shows
// nothing there.
Vec2d position_on_view(const View& view, Vec2d photo_pixel);

}  // namespace cei3d
