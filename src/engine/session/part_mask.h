// SPDX-License-Identifier: Apache-2.0
// A part as seen in one view.
#pragma once

#include "engine/render/render.h"

namespace cei3d {

// Share of each pixel's samples that meet the part: 1 channel.
Image part_mask(const Scene&, const EditLayer& part, const GBuffer&);

}  // namespace cei3d
