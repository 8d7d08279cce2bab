// SPDX-License-Identifier: Apache-2.0
// Handler points: explicit points of the surface, sampled at the ray hits of the training views and thinned
// to a known spacing. [paper sec. 4.1]
#pragma once

#include <span>
#include <vector>

#include "core/math/vec.h"
#include "model/geometry/shape/hit.h"

namespace cei3d {

struct HandlerPoints {
  std::vector<Vec3f> positions;  // #N, unit frame
  std::vector<Vec3f> normals;    // #N, unit
  // #N, distance on the surface between the hits of neighboring pixels, in the view that sees the point best.
  std::vector<float> footprints;
  float spacing = 0;  // minimum distance between points; every hit they were made from has one within it
};

// Keeps, in a fixed order, every hit that has no kept point within `spacing` on the same side of the surface.
// footprints: #hits.
HandlerPoints thin_hits(std::span<const Hit> hits, std::span<const float> footprints, float spacing);

}  // namespace cei3d
