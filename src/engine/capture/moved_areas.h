// SPDX-License-Identifier: Apache-2.0
// Where the views that show a moved part in another place than most do must not be believed.
// docs/method.md#masks-that-are-a-little-wrong
#pragma once

#include <vector>

#include "engine/capture/moved_part.h"

namespace cei3d {

// In the views of the position that fewer show, the pixels where the part may be in either position: of the
// place, joined to it what contradicts the other views, and near it the pieces of the object that these cut
// off from the rest. In all others an empty area. masks: at the size
// of the result, of the same views as those in which the part was found.
std::vector<Area> moved_areas(const SmallMasks& masks, const MovedPart&);

}  // namespace cei3d
