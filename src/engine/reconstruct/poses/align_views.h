// SPDX-License-Identifier: Apache-2.0
// Moves the cameras of all views to where a trained model says that they stood.
#pragma once

#include <vector>

#include "core/base/progress.h"
#include "engine/reconstruct/geometry/geometry_stage.h"
#include "engine/reconstruct/pixels.h"
#include "engine/reconstruct/poses/align_view.h"

namespace cei3d {

struct AlignedViews {
  std::vector<Camera> cameras;  // of the store's views, moved
  double pixels = 0;  // median over views of how far they move the object in the image, in its pixels
};

// model: trained on these pixels. side: of the images that are compared, at most; pixels. What all
// cameras would have in common is taken out of their motions: the object stays where and as large as it is.
// Error: interrupted.
AlignedViews align_views(GeometryStage& model, const PixelStore&, int side, const Progress&);

// Takes out of the motions of these cameras what all have in common: a turn, a shift, and a step away from
// the origin, as far as they move the object in the images.
void keep_frame(std::span<const Camera>, std::vector<Alignment>&);

// Photographs at 1/n of their size as alignment compares them: color over white, alpha 1 where it is known.
std::vector<Image> photographs_over_white(const PixelStore&, std::span<const int> n);

}  // namespace cei3d
