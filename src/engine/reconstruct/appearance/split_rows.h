// SPDX-License-Identifier: Apache-2.0
// The rows of the linear separation: one for each sample, independent of materials.
#pragma once

#include <array>
#include <vector>

#include "engine/reconstruct/appearance/linear_split.h"
#include "model/geometry/shape/surface.h"

namespace cei3d {

struct SplitRow {
  std::array<uint32_t, 3> vertices;      // of the triangle of the hit
  std::array<float, 3> barycentric;      // of the hit
  Vec3f normal, to_camera;               // unit, in the frame of the light
  float nv;                              // cosine of normal and to_camera
  bool blocked;                          // whether the mirror ray meets the surface again, at the "far" point
  std::array<uint32_t, 3> far_vertices;  // of the triangle of the far point
  std::array<float, 3> far_barycentric;  // of the far point
  Vec3f color;                           // linear
  Vec3f weight;                          // squared slope of the display curve
  uint8_t clipped;                       // SurfaceSamples::clipped
  uint16_t view = 0;                     // index of the camera; 0 where the samples have no views
  bool held_out = false;                 // takes no part in the solution, only in its residual
  // Irradiance in this view over the mean of all views; 1 under a light that does not turn.
  Vec3f diffuse_light{1, 1, 1};
  Vec3f far_diffuse_light{1, 1, 1};  // at the far point
};

// A row for each sample of the random subset of options.max_hits samples.
std::vector<SplitRow> make_split_rows(const Surface&, const SurfaceSamples&, const LinearSplitOptions&);

}  // namespace cei3d
