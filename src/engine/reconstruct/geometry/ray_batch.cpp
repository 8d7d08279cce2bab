// SPDX-License-Identifier: Apache-2.0
#include "engine/reconstruct/geometry/ray_batch.h"

#include "core/math/rng.h"

namespace cei3d {

namespace {

const Vec3f kWhite{1, 1, 1};

Rng rng_of(const BatchKey& key, int ray) { return {key.seed, uint64_t(key.step), uint64_t(key.item + ray)}; }

// Through the center of the pixel and not anywhere in it: each ray is compared with the mean over the pixel,
// so that spread rays would blur it once more.
void add_pixel(const PixelStore& store, size_t pixel, RayBatch& batch) {
  const Pixel& p = store.pixels()[pixel];
  batch.pixels.push_back(pixel);
  batch.rays.push_back(store.ray(p));
  batch.targets.push_back(store.target(p));
}

}  // namespace

RayBatch training_rays(const PixelStore& store, const PixelErrors& errors, const BatchKey& key, int count) {
  RayBatch batch;
  for (int r = 0; r < count; ++r) {
    Rng rng = rng_of(key, r);
    add_pixel(store, errors.choose(rng), batch);
    Target& target = batch.targets.back();
    batch.empty.push_back(target.alpha == 0);
    // A new background for each ray: only a surface that covers the pixel has the right color over all of
    // them.
    const Vec3f background{rng.uniform(), rng.uniform(), rng.uniform()};
    batch.backgrounds.push_back(background);
    target.srgb += (background - kWhite) * (1 - target.alpha);
  }
  return batch;
}

RayBatch random_rays(const PixelStore& store, const BatchKey& key, int count) {
  RayBatch batch;
  for (int r = 0; r < count; ++r)
    add_pixel(store, rng_of(key, r).below(uint32_t(store.pixels().size())), batch);
  batch.backgrounds.assign(size_t(count), kWhite);
  batch.empty.assign(size_t(count), 0);
  return batch;
}

void turn_light(const LightFrame& frame, const PixelStore& store, RayBatch& batch) {
  if (frame.motion == LightMotion::world) return;
  for (const size_t p : batch.pixels)
    batch.room_from_object.push_back(
        frame.room_from_object(store.cameras()[store.pixels()[p].view].world_from_cam));
}

RayBatch view_rays(std::vector<Ray> rays) {
  RayBatch batch;
  batch.rays = std::move(rays);
  batch.backgrounds.assign(batch.rays.size(), kWhite);
  batch.empty.assign(batch.rays.size(), 0);
  return batch;
}

}  // namespace cei3d
