// SPDX-License-Identifier: Apache-2.0
// The surface of a field, and its hits by training pixels.
#pragma once

#include <memory>

#include "core/base/progress.h"
#include "engine/reconstruct/appearance/appearance_stage.h"
#include "engine/reconstruct/pixels.h"
#include "model/geometry/mesh/surface_nets.h"
#include "model/geometry/shape/handlers.h"

namespace cei3d {

// Pixels wholly on the object whose ray meets the surface.
struct ObjectHits {
  std::vector<Hit> hits;
  std::vector<Vec3f> colors;      // linear
  std::vector<uint8_t> clipped;   // SurfaceSamples::clipped
  std::vector<uint16_t> views;    // index of the camera
  std::vector<float> footprints;  // distance between neighboring pixels on the surface, unit frame
  // turns: of the cameras; null: the light is fixed to the object.
  SurfaceSamples samples(const LightTurns* turns = nullptr) const {
    return {hits, colors, clipped, footprints, {turns, views}};
  }
};

struct HitOptions {
  size_t max_hits;      // approximate maximum; beyond it a random subset of the pixels
  uint64_t subset = 0;  // index of the random subset
};

// Pixels wholly on the object whose hits are not known yet. In place of the hit stands the point of the ray
// that is nearest to the origin, with the footprint there; normals and triangles mean nothing.
ObjectHits object_rays(const PixelStore&, const HitOptions&);

// Of the pixels at edges (edge_pixels.h) one in eight, unless there are few pixels. Error: interrupted.
ObjectHits object_hits(const Device&, const Field& sdf, const Surface&, const PixelStore&, const HitOptions&,
                       const Progress&);

// Error: interrupted.
std::shared_ptr<const Surface> extract_surface(const Device&, const Field& sdf, const MeshingOptions&,
                                               const Progress&);

struct SurfaceAndHits {
  std::shared_ptr<const Surface> surface;
  ObjectHits hits;
  AppearanceInput input(const LightTurns* turns) const { return {surface, hits.samples(turns)}; }
};

// Errors: no image shows the surface; interrupted.
SurfaceAndHits extract_surface_and_hits(const Device&, const Field& sdf, const MeshingOptions&,
                                        const PixelStore&, size_t max_hits, const Progress&);

// footprint: TrainingViews::footprint.
std::shared_ptr<const HandlerPoints> handlers_of(const ObjectHits&, double footprint);

}  // namespace cei3d
