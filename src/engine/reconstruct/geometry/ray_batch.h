// SPDX-License-Identifier: Apache-2.0
// The rays of one chunk, what the images show along them, and the places where they are sampled.
#pragma once

#include <vector>

#include "core/math/camera.h"
#include "engine/reconstruct/geometry/pixel_errors.h"
#include "engine/reconstruct/pixels.h"
#include "model/light/light_turns.h"

namespace cei3d {

struct RayBatch {
  std::vector<size_t> pixels;           // #rays, indices in their store; empty for the rays of a new view
  std::vector<Ray> rays;                // unit frame
  std::vector<Target> targets;          // #rays, over `backgrounds`; empty for the rays of a new view
  std::vector<Vec3f> backgrounds;       // #rays, display-encoded color of a ray that meets nothing
  std::vector<uint8_t> empty;           // #rays, 1 where training knows that the ray meets nothing
  std::vector<Mat3f> room_from_object;  // #rays, rotation of the light; empty where it stands still
  int count() const { return int(rays.size()); }
};

// Depths of samples, ray after ray, front to back: those of ray r are [first[r], first[r + 1]).
struct RaySamples {
  std::vector<float> depths;
  std::vector<int> first{0};
  int count() const { return int(depths.size()); }
};

// Names the random numbers of a batch: those of one ray are keyed by (seed, step, item + index of the ray).
struct BatchKey {
  uint64_t seed;
  int64_t step;
  int item;
};

// Rays through pixels with large errors, each over a random background.
RayBatch training_rays(const PixelStore&, const PixelErrors&, const BatchKey&, int count);
// Rays through random pixels, over white.
RayBatch random_rays(const PixelStore&, const BatchKey&, int count);
// Given rays, over white.
RayBatch view_rays(std::vector<Ray> rays);
// Sets room_from_object of a batch of pixels of the store.
void turn_light(const LightFrame&, const PixelStore&, RayBatch&);

}  // namespace cei3d
