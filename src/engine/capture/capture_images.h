// SPDX-License-Identifier: Apache-2.0
// Loads images and masks of a capture's views.
#pragma once

#include <cstdint>
#include <vector>

#include "core/image/image.h"
#include "model/geometry/shape/visual_hull.h"
#include "model/scene/view.h"

namespace cei3d {

// RGBA, linear, straight alpha. Alpha: the mask file's luminance where the view has one (nearly black: 0,
// nearly white: 1), else the image's own, else 1. PNG and JPEG are sRGB; EXR and HDR are linear as stored. A
// view that was photographed through a lens is undistorted; alpha is kUnknownAlpha where its photograph shows
// nothing. An image whose sides are swapped is turned as its EXIF orientation says. A mask of another size is
// scaled. Errors name the file: missing, broken, other size than the camera, other proportions than the mask,
// NaN or infinite values.
Image load_linear_rgba(const View& view);

struct Mask {
  int width = 0, height = 0;
  std::vector<uint8_t> object;  // [height][width]: kObject, kBackground, kUnknown
  bool stated = true;           // false: neither a mask nor an alpha channel, all pixels are object
};
// Object where alpha > 0.5. Errors as above.
Mask load_mask(const View& view);

// As the files have it: of the photograph's size, before any lens is undone.
Mask load_file_mask(const View& view);

// Loads images on demand. downscale N: at 1/N of their size; their cameras are scaled(camera, N).
class CaptureImages : public ImageSource {
 public:
  explicit CaptureImages(int downscale = 1) : downscale_(downscale) {}
  Image load(const View& view) const override;
  ImageDepth depth(const View& view) const override;
  std::optional<double> exposure(const View& view) const override;  // EXIF of JPEG files

 private:
  int downscale_;
};

}  // namespace cei3d
