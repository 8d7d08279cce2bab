// SPDX-License-Identifier: Apache-2.0
// Masks judged by each other: a mask that contradicts nearly all other views is overruled where it does.
// docs/method.md#masks-that-are-a-little-wrong
#pragma once

#include <span>
#include <vector>

#include "core/image/area.h"
#include "model/geometry/shape/visual_hull.h"
#include "model/scene/normalization.h"

namespace cei3d {

// Masks at a size that is enough to compare them.
struct SmallMasks {
  std::vector<Camera> cameras;  // unit frame
  std::vector<std::vector<uint8_t>> masks;
  std::vector<HullMask> views() const;
};
inline constexpr int kSmallMask = 160;  // pixels of the longer side, at most
// By how much an image of this size is reduced.
int reduction_of(int width, int height, int max_side = kSmallMask);
// masks: cameras in the capture frame. Views of about one focal length are reduced by the same factor,
// however they were cropped to the object: of an outline that is drawn more finely than others more stays in
// doubt.
SmallMasks small_masks(std::span<const HullMask> masks, const Normalization&, int max_side = kSmallMask);

struct MaskDoubt {
  int width = 0, height = 0;  // of the small mask
  Area consensus;             // what the other views take for the object
  Area missing_area;          // the part of `doubtful` where this mask has background
  Area doubtful;              // pixels about which the other views do not agree with this mask
  // As shares of the mask's object pixels: background that the other views take for the object, and the
  // reverse.
  double missing = 0, extra = 0;
  bool stands_out = false;  // disagrees far more than most masks do; only then it is overruled
};

// One for each mask.
std::vector<MaskDoubt> vote_on_masks(const SmallMasks& masks);

// Pixels of the area, of the mask's size, as a share of its object pixels.
double share_of_object(const Area& area, std::span<const uint8_t> mask);

// An area of a reduced mask at the size of the view, with a reduced pixel around it: its outline is coarse.
Area enlarged(const Area& area, int small_width, int small_height, int width, int height);
// The same for the area of a small mask; empty: empty.
Area at_full_size(const Area& area, const Camera& small, const Camera& full);

}  // namespace cei3d
