// SPDX-License-Identifier: Apache-2.0
// Width and height of an image file.
#pragma once

namespace cei3d {

struct ImageSize {
  int width = 0, height = 0;  // pixels
  bool operator==(const ImageSize&) const = default;
};

// Whether one is the other scaled, up to rounding to whole pixels.
inline bool same_proportions(ImageSize a, ImageSize b) {
  const double cross = double(a.width) * b.height - double(a.height) * b.width;
  return (cross < 0 ? -cross : cross) <= double(a.width + a.height + b.width + b.height) / 2;
}

}  // namespace cei3d
