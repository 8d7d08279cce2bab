// SPDX-License-Identifier: Apache-2.0
// Depth by plane sweep: what a window of a picture shows must be found again in neighboring pictures.
// Texture that repeats in color but not in detail (bricks, tiles) tells a hollow from its mouth here, where
// descent on colors cannot. [Collins 1996; Goesele et al. 2006]
#pragma once

#include <span>
#include <vector>

#include "core/base/progress.h"
#include "engine/reconstruct/pixels.h"
#include "model/geometry/shape/visual_hull.h"

namespace cei3d {

struct StereoOptions {
  size_t pixels = 6000000;   // of all depth maps together; the pictures are shrunk until they fit
  int neighbors = 4;         // pictures that one is compared with
  int window = 3;            // half width, pixels
  float least_score = 0.6f;  // mean correlation with the two neighbors that agree best
  float agreement = 1.5f;    // of neighboring maps about a point, in planes
};

struct DepthMap {
  Camera camera;             // of the shrunk and cropped picture
  std::vector<float> depth;  // [y][x] z-depth, unit-sphere units; 0: unknown
};

// One map a view; depths only where the masks show the object, and only what a second map confirms. Same bits
// whatever the number of threads.
std::vector<DepthMap> stereo_depths(const PixelStore&, const VisualHull&, const StereoOptions&,
                                    const Progress& progress = Progress());

// The hull's cells without those that the maps see through.
VisualHull carve_by_depths(const VisualHull&, std::span<const DepthMap>);

}  // namespace cei3d
