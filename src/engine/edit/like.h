// SPDX-License-Identifier: Apache-2.0
// Handler points of the same material as a clicked point.
#pragma once

#include "engine/edit/part.h"

namespace cei3d {

// Similarity of the handler points to the surface seen at the request's pixel: #handlers, [0, 1]; 1/2 is the
// threshold. Errors: the pixel is outside the image or shows the background; the whole object is similar.
std::vector<float> like_scores(const Device&, const Scene&, const PartRequest&);

}  // namespace cei3d
