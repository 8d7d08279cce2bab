// SPDX-License-Identifier: Apache-2.0
// A part from clicks, in 3D and without a network: color, creases and distance on the handler points.
#pragma once

#include <span>
#include <vector>

#include "engine/segment/compete.h"
#include "model/geometry/shape/handlers.h"
#include "model/geometry/shape/pose.h"

namespace cei3d {

// The handler points around clicked points of the surface (within two spacings on the same side, or the
// nearest one). A point that clicks of both kinds reach belongs to neither. Returns #N. Usage error: two
// clicks, one of each kind, that have the same nearest point.
std::vector<Seed> click_seeds(const HandlerPoints&, std::span<const SurfacePoint> positive,
                              std::span<const SurfacePoint> negative);

// How much each handler point belongs to the part, [0, 1]: to be interpolated (ScoredPoints). base_colors:
// #N, linear. Time: about n log n in the points; 200 000 take some seconds on one core.
std::vector<float> grow(const HandlerPoints&, std::span<const Vec3f> base_colors,
                        std::span<const Seed> seeds);

}  // namespace cei3d
