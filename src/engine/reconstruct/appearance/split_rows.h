// SPDX-License-Identifier: Apache-2.0
// The rows of the linear separation: one for each sample, independent of materials.
#pragma once

#include <array>
#include <vector>

#include "engine/reconstruct/appearance/hidden_sky.h"
#include "engine/reconstruct/appearance/linear_split.h"
#include "engine/render/light_direction.h"
#include "model/geometry/shape/surface.h"

namespace cei3d {

struct SplitRow {
  std::array<uint32_t, 3> vertices;  // of the triangle of the hit
  std::array<float, 3> barycentric;  // of the hit
  Vec3f normal, to_camera;           // unit, in the frame of the light
  float nv;                          // cosine of normal and to_camera
  HiddenRings hidden;                // what the surface hides of the sky about the mirror direction
  // The far point is the one in the middle of what hides the sky.
  std::array<uint32_t, 3> far_vertices;  // of the triangle of the far point
  std::array<float, 3> far_barycentric;  // of the far point
  Vec3f far_color;                       // mean color of the samples at the far point, linear
  Vec3f color;                           // linear
  Vec3f weight;                          // squared slope of the display curve, times `trust`
  float trust;                           // in (0, 1]; less where the surface hides a part of the sky
  uint8_t clipped;                       // SurfaceSamples::clipped
  uint16_t view = 0;                     // index of the camera; 0 where the samples have no views
  bool held_out = false;                 // takes no part in the solution, only in its residual
  // Irradiance in this view over the mean of all views; 1 under a light that does not turn.
  Vec3f diffuse_light{1, 1, 1};
  Vec3f far_diffuse_light{1, 1, 1};  // at the far point
  Vec3f far_radiance() const { return far_color * far_diffuse_light; }
};

// Of the row's point, seen by its camera under a light whose directions these are.
inline float diffuse_view_of(const SplitRow& row, float roughness, const LightDirectionMap& light) {
  return diffuse_view(clamp(row.nv, 0.0f, 1.0f), roughness, light.at(row.normal).towards(row.to_camera));
}

// Mean linear color of each vertex's samples that are not held out, 0 where there are none. #V
std::vector<Vec3f> mean_colors(const Mesh&, const SurfaceSamples&, const LinearSplitOptions&);

// A row for each sample of the random subset of options.max_hits samples. colors: mean_colors().
std::vector<SplitRow> make_split_rows(const Surface&, const SurfaceSamples&, const LinearSplitOptions&,
                                      const std::vector<Vec3f>& colors);

}  // namespace cei3d
