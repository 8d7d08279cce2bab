// SPDX-License-Identifier: Apache-2.0
// What is made of the same material as a clicked point.
#pragma once

#include "engine/edit/part.h"

namespace cei3d {

// How like the surface seen at the request's pixel the handler points are: #handlers in [0, 1]; one half
// where they differ as much as the same material may. Errors: the pixel is outside the image or shows the
// background; the whole object is like it.
std::vector<float> like_scores(const Device&, const Scene&, const PartRequest&);

}  // namespace cei3d
