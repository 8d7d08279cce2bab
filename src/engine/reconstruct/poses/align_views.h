// SPDX-License-Identifier: Apache-2.0
// Compares the photographs of all views with a trained model: where their cameras stood, and how bright they
// are.
#pragma once

#include <vector>

#include "core/base/progress.h"
#include "engine/reconstruct/geometry/geometry_stage.h"
#include "engine/reconstruct/pixels.h"
#include "engine/reconstruct/poses/align_view.h"

namespace cei3d {

// Photographs and model beside each other, at 1/reduction of the size of the views.
struct ShownViews {
  std::vector<int> reductions;
  std::vector<Image> photographs;  // photographs_over_white()
  std::vector<ModelView> models;
};
// model: trained on these pixels. side: of the images, at most; pixels. Error: interrupted.
ShownViews show_views(GeometryStage& model, const PixelStore&, int side, const Progress&);

struct AlignedViews {
  std::vector<Camera> cameras;  // of the store's views, moved
  double pixels = 0;  // median over views of how far they move the object in the image, in its pixels
};

// What all cameras would have in common is taken out of their motions: the object stays where and as large as
// it is.
AlignedViews align_views(const ShownViews&, const PixelStore&);

// Factors by which the photographs are brighter than the model, on top of those that the store has: its new
// ones, of which the geometric mean is 1. A view that shows too little keeps its own.
std::vector<Vec3f> find_exposures(const ShownViews&, const PixelStore&);
// Root mean square of the logarithm of b over a, over views and channels. Empty: all are 1.
double exposure_change(std::span<const Vec3f> a, std::span<const Vec3f> b);

// Takes out of the motions of these cameras what all have in common: a turn, a shift, and a step away from
// the origin, as far as they move the object in the images.
void keep_frame(std::span<const Camera>, std::vector<Alignment>&);

// Photographs at 1/n of their size as alignment compares them: color over white, alpha 1 where it is known.
std::vector<Image> photographs_over_white(const PixelStore&, std::span<const int> n);

}  // namespace cei3d
