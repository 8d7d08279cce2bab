// SPDX-License-Identifier: Apache-2.0
#include "engine/edit/handler_colors.h"

#include "model/scene/appearance.h"
#include "model/scene/handler_hits.h"

namespace cei3d {

std::vector<Vec3f> handler_colors(const Device& device, const Scene& scene) {
  return appearance_at(device, scene, handler_hits(scene)).albedo;
}

Image albedo_image(const Device& device, const Scene& scene, const Camera& camera) {
  const GBuffer traced = trace_view(device, scene, camera, 2, OnSurface::mesh);
  const std::vector<Vec3f> albedo = appearance_at(device, scene, traced.hits).albedo;
  Image picture(traced.width, traced.height, 4);
  for (size_t pixel = 0; pixel + 1 < traced.pixel_start.size(); ++pixel) {
    const uint32_t begin = traced.pixel_start[pixel], end = traced.pixel_start[pixel + 1];
    if (begin == end) continue;
    Vec3f sum{0, 0, 0};
    for (uint32_t h = begin; h < end; ++h) sum += albedo[h];
    for (int c = 0; c < 3; ++c) picture.data[4 * pixel + c] = sum[c] / float(end - begin);
    picture.data[4 * pixel + 3] = float(end - begin) / float(traced.samples_of(pixel));
  }
  return picture;
}

}  // namespace cei3d
