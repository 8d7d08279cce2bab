// SPDX-License-Identifier: Apache-2.0
// The surface of a field, and where the training pictures show it.
#pragma once

#include <memory>

#include "engine/reconstruct/appearance/appearance_stage.h"
#include "engine/reconstruct/pixels.h"
#include "engine/reconstruct/presets.h"

namespace cei3d {

// Pixels wholly on the object that meet the surface.
struct ObjectHits {
  std::vector<Hit> hits;
  std::vector<Vec3f> colors;     // linear
  std::vector<uint8_t> clipped;  // SurfaceSamples::clipped
  std::vector<uint16_t> views;
  std::vector<float> footprints;  // distance between neighbouring pixels on the surface
};

// A random subset of at most about `most` of them; another one for another `subset`.
ObjectHits object_hits(const Device&, const Field& sdf, const Surface&, const PixelStore&, size_t most,
                       uint64_t subset = 0);

struct Standing {
  std::shared_ptr<const Surface> surface;
  ObjectHits hits;
  AppearanceInput input() const { return {surface, {hits.hits, hits.colors, hits.clipped, hits.footprints}}; }
};

// Error: no picture shows the surface.
Standing stand(const Device&, const Field& sdf, const Preset&, const PixelStore&);

}  // namespace cei3d
