// SPDX-License-Identifier: Apache-2.0
// From the edited scene to a finished asset: simplified, unwrapped, baked.
#pragma once

#include "core/base/progress.h"
#include "core/compute/device.h"
#include "engine/export/asset.h"
#include "model/geometry/unwrap/atlas.h"
#include "model/scene/scene.h"

namespace cei3d {

struct AssetOptions {
  size_t faces = 50000;  // at most, as far as simplification can get there
  int texture = 2048;    // texels of a side
  PictureKind pictures = PictureKind::png;
  PlacementOptions placement;
};

struct AssetReport {
  size_t vertices = 0, triangles = 0;
  uint32_t charts = 0;
  AtlasQuality atlas;
  double error = 0;  // of the simplification, capture units
};

struct MadeAsset {
  Asset asset;
  Textures textures;
  AssetReport report;
};

// Errors: no surface; so many pieces that the texture has no room for them; the interrupted one.
MadeAsset make_asset(const Device& device, const Scene& scene, const std::string& name,
                     const AssetOptions& options, Progress& progress);

}  // namespace cei3d
