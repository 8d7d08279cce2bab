// SPDX-License-Identifier: Apache-2.0
// `edit paint`: a scribble on one view becomes a layer with a region and an albedo branch of its own.
// [paper sec. 3.3; architecture 1.2]
#pragma once

#include <string>

#include "core/base/progress.h"
#include "core/image/image.h"
#include "engine/render/render.h"

namespace cei3d {

struct PaintRequest {
  Camera camera;   // of the painted view, unit-sphere frame
  Image scribble;  // RGBA, sRGB, straight alpha, of the camera's size; painted where alpha >= 0.5. Its colour
                   // is the display colour of the base colour wanted there
  std::string id;  // of the new layer
  uint64_t seed = 1;  // of the branch's weights and batches
};

struct PaintReport {
  int painted_pixels = 0;
  int missed_pixels = 0;                        // painted, but not on a surface that faces the view
  size_t points = 0;                            // edited handler points
  float mean_error = 0, max_error = 0;          // of the branch on the painted surface, linear
  double trace_seconds = 0, train_seconds = 0;  // stages
};

struct PaintResult {
  EditLayer layer;
  PaintReport report;
};

// A pure function: the scene is not changed. Errors: scribble of another size, without alpha or with nothing
// opaque, paint that meets no surface, cancelled.
PaintResult paint(const Device&, const Scene&, const PaintRequest&, Progress&);

}  // namespace cei3d
