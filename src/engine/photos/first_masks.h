// SPDX-License-Identifier: Apache-2.0
// The first round of masks: prompts are triangulated points; every mask votes on the points that it shows.
#pragma once

#include "engine/photos/object_masks.h"
#include "engine/photos/photo_segmenter.h"
#include "engine/photos/sparse_points.h"

namespace cei3d {

// Writes request.first_masks. Returns the score of each point; above 0: on the object. Errors: those of
// make_masks().
PointBelief make_first_masks(const MaskRequest&, const SparsePoints&, PhotoSegmenter&, double first,
                             double last, Progress&);

}  // namespace cei3d
