// SPDX-License-Identifier: Apache-2.0
// Depth by plane sweep: windows of an image are matched with neighboring images. Detects hollows in surface
// with texture whose mean color is uniform (bricks, tiles), which carving by colors cannot. [Collins 1996;
// Goesele et al. 2006]
#pragma once

#include <span>
#include <vector>

#include "core/base/progress.h"
#include "engine/reconstruct/pixels.h"
#include "model/geometry/shape/visual_hull.h"

namespace cei3d {

struct StereoOptions {
  size_t pixels = 6000000;  // maximum sum over all depth maps; the images are downscaled to fit
  int neighbors = 4;        // number of images that each image is matched with
  int window = 3;           // half width, pixels
  float min_score = 0.6f;   // minimum mean correlation with the two neighbors that agree best
  float agreement = 1.5f;   // maximum difference of the depth of a point in two maps, in planes
};

struct DepthMap {
  Camera camera;             // of the downscaled and cropped image
  std::vector<float> depth;  // [y][x] z-depth, unit frame; 0: unknown
};

// One map per view, with depths where the mask shows the object and a second map confirms them. The same bits
// for any number of threads.
std::vector<DepthMap> stereo_depths(const PixelStore&, const VisualHull&, const StereoOptions&,
                                    const Progress& progress = Progress());

// The hull without the cells in front of the surface of the maps.
VisualHull carve_by_depths(const VisualHull&, std::span<const DepthMap>);

}  // namespace cei3d
