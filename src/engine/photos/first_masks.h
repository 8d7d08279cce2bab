// SPDX-License-Identifier: Apache-2.0
// The first round of masks: prompts are triangulated points, which each mask says more about.
#pragma once

#include "engine/photos/object_masks.h"
#include "engine/photos/photo_segmenter.h"
#include "engine/photos/sparse_points.h"

namespace cei3d {

// Writes request.first_masks. Returns what is then believed of the points: on the object where above 0.
// Errors: those of make_masks().
PointBelief make_first_masks(const MaskRequest&, const SparsePoints&, PhotoSegmenter&, double first,
                             double last, Progress&);

}  // namespace cei3d
