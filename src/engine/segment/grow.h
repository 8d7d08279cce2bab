// SPDX-License-Identifier: Apache-2.0
// Selects a part from clicks in 3D, without a network: by color, creases and distance between handler points.
#pragma once

#include <span>
#include <vector>

#include "engine/segment/compete.h"
#include "model/geometry/shape/handlers.h"
#include "model/geometry/shape/shape_version.h"

namespace cei3d {

// Seeds at clicked points of the surface: the handler points within two spacings on the same side, or the
// nearest one. A point within reach of clicks of both kinds gets no seed. Returns #N. Usage error: a positive
// and a negative click have the same nearest point.
std::vector<Seed> click_seeds(const HandlerPoints&, std::span<const SurfacePoint> positive,
                              std::span<const SurfacePoint> negative);

// Seeds along strokes, given by points of the surface: the handler points within a spacing on the same side,
// or the nearest one. A point within reach of strokes of both kinds gets no seed. Returns #N.
std::vector<Seed> stroke_seeds(const HandlerPoints&, std::span<const SurfacePoint> positive,
                               std::span<const SurfacePoint> negative);

// Score of each handler point, [0, 1], to be interpolated by ScoredPoints. albedo: #N linear albedo.
// Time: about n log n in the points; 200 000 take some seconds on one core.
std::vector<float> grow(const HandlerPoints&, std::span<const Vec3f> albedo, std::span<const Seed> seeds,
                        const GraphOptions& = {});

}  // namespace cei3d
