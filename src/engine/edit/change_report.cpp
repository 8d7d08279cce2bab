// SPDX-License-Identifier: Apache-2.0
#include "engine/edit/change_report.h"

#include <algorithm>
#include <cstring>

#include "engine/render/render_cache.h"
#include "model/scene/appearance.h"

namespace cei3d {
namespace {

bool is_local(const EditLayer& l) { return !l.everywhere && !l.light; }

// For each pixel: whether one of its own samples belongs to the edit.
std::vector<uint8_t> touched_pixels(const Device& device, const Scene& scene, const GBuffer& before,
                                    const GBuffer& after) {
  const int last = int(scene.layers.size()) - 1;
  const bool local = is_local(scene.layers.back());
  const std::vector<int> layer = appearance_at(device, scene, after.hits).layer;
  std::vector<uint8_t> touched(after.pixel_start.size() - 1, 0);
  for (size_t p = 0; p < touched.size(); ++p) {
    const uint32_t a = after.pixel_start[p], b = before.pixel_start[p], n = after.pixel_start[p + 1] - a;
    touched[p] = n != before.pixel_start[p + 1] - b;
    for (uint32_t i = 0; i < n && !touched[p]; ++i)
      touched[p] = !local || layer[a + i] == last ||
                   std::memcmp(&after.hits[a + i].position, &before.hits[b + i].position, sizeof(Vec3f)) != 0;
  }
  return touched;
}

// A pixel's color is a mean of samples up to one pixel away.
std::vector<uint8_t> with_neighbors(const std::vector<uint8_t>& mask, int width, int height) {
  std::vector<uint8_t> out(mask.size(), 0);
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x)
      for (int v = std::max(0, y - 1); v <= std::min(height - 1, y + 1); ++v)
        for (int u = std::max(0, x - 1); u <= std::min(width - 1, x + 1); ++u)
          out[size_t(y) * width + x] |= mask[size_t(v) * width + u];
  return out;
}

}  // namespace

ChangeReport compare_views(const Device& device, RenderCache& frames, const Scene& before, const Scene& after,
                           const Camera& camera, int samples) {
  const auto a = frames.trace(before, camera, samples), b = frames.trace(after, camera, samples);
  ChangeReport r;
  // Shaded independently, without shared memory of hits, so that the comparison is a real check.
  r.before = shade_view(device, before, frames.light(before), a->buffer);
  r.after = shade_view(device, after, frames.light(after), b->buffer);
  const std::vector<uint8_t> inside =
      with_neighbors(touched_pixels(device, after, a->buffer, b->buffer), camera.width, camera.height);
  for (size_t p = 0; p < inside.size(); ++p) {
    const bool changed =
        std::memcmp(&r.before.rgb.data[4 * p], &r.after.rgb.data[4 * p], 4 * sizeof(float)) != 0;
    r.pixels_inside += inside[p];
    r.pixels_changed += changed;
    r.changed_outside += changed && !inside[p];
  }
  return r;
}

}  // namespace cei3d
