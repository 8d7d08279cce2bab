// SPDX-License-Identifier: Apache-2.0
// Where the light that reaches a surface comes from, by the normal of the surface. Burley's diffuse term
// depends on it: at grazing angles a rough surface is brighter on the side of the light. [Burley 2012,
// sec. 5.3]
#pragma once

#include "engine/render/direction_map.h"
#include "engine/render/transport.h"

namespace cei3d {

// Table of the mean direction, weighted by the luminance of the light and the cosine to the normal; shorter
// where light comes from all around: 2/3 of the normal under even light.
DirectionMap light_directions(const SkyRadiance&);

}  // namespace cei3d
