// SPDX-License-Identifier: Apache-2.0
// Small parts of the background that one mask takes for the object, like the gap under a handle: nearly all
// other views look past the object there. docs/method.md#masks-that-are-a-little-wrong
#pragma once

#include <span>
#include <vector>

#include "core/image/area.h"
#include "engine/capture/mask_votes.h"

namespace cei3d {

inline constexpr int kGapMask = 640;  // pixels of the longer side of the masks, at most

// One area for each mask, of its size. Empty: the mask fills no gap, or hardly more than most others do.
// has_vote: of each mask, whether it speaks against others; those that show the object in another state than
// most must not.
std::vector<Area> filled_gaps(const SmallMasks& masks, std::span<const uint8_t> has_vote);

}  // namespace cei3d
