// SPDX-License-Identifier: Apache-2.0
// The light as planes of numbers, which shading kernels read.
#pragma once

#include <vector>

#include "model/light/sg_mixture.h"

namespace cei3d {

// The planes that LobePlanes points to, for padded_to_panels(#lobes) lobes; sharpness within the range that
// shading can represent.
std::vector<float> lobe_planes(const SgMixture& light);

}  // namespace cei3d
