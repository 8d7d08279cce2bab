// SPDX-License-Identifier: Apache-2.0
// Compares the photographs of all views with a trained model: where their cameras stood, and how bright they
// are.
#pragma once

#include <span>
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

// Number of pixels of its photographs, or of its models.
size_t pixels_shown(const PixelStore&, int side);

struct AlignedViews {
  std::vector<Camera> cameras;  // of the store's views, moved
  double focal = 1;             // factor on the focal lengths that they had
  double pixels = 0;  // median over views of how far they move the object in the image, in its pixels
};

// Prior on the focal length.
struct FocalPrior {
  double error = 0;  // standard deviation of the logarithm of the capture's focal length; 0: it is exact
  double found = 1;  // factor on the capture's focal length that the cameras of the store have already
};

// Aligns every camera with the model by align_view(), then keep_frame(), so that the object keeps its place
// and size. Changes the focal length of all by one factor, if the photographs determine it well enough.
AlignedViews align_views(const ShownViews&, const PixelStore&, const FocalPrior& = {});

// Logarithm of the factor on the focal length that fits all views best; call it after align_pose(). Applies
// the factor to the views. 0: the focal length is undetermined; the views must then be discarded.
double change_focal(std::span<ViewAligner> views, const FocalPrior&);

// New exposures for the store: its present ones, times the factors by which the photographs are brighter than
// the model, with a geometric mean of 1. A view that shows too little of the object gets no factor.
std::vector<Vec3f> find_exposures(const ShownViews&, const PixelStore&);
// Root mean square of the logarithm of b over a, over views and channels. Empty: all are 1.
double exposure_change(std::span<const Vec3f> a, std::span<const Vec3f> b);

// Subtracts what the motions of these cameras have in common: a turn, a shift, and a step away from the
// origin. Fitted to how they move the object in the images.
void keep_frame(std::span<const Camera>, std::vector<Alignment>&);

// Photographs at 1/n of their size as alignment compares them: color over white, alpha 1 where it is known.
std::vector<Image> photographs_over_white(const PixelStore&, std::span<const int> n);

}  // namespace cei3d
