// SPDX-License-Identifier: Apache-2.0
#include "engine/edit/handler_colors.h"

#include "model/scene/appearance.h"

namespace cei3d {

std::vector<Vec3f> handler_colors(const Device& device, const Scene& scene) {
  const HandlerPoints& handlers = *scene.handlers;
  // Straight down onto the surface, which says what triangle the point is of.
  std::vector<Ray> rays;
  for (size_t i = 0; i < handlers.positions.size(); ++i)
    rays.push_back(
        {handlers.positions[i] + handlers.normals[i] * (2 * handlers.spacing), -handlers.normals[i]});
  std::vector<uint32_t> ray_of_hit;
  const std::vector<Hit> hits = trace_rays(device, scene, rays, ray_of_hit);
  const std::vector<Vec3f> albedo = appearance_at(device, scene, hits).albedo;
  std::vector<Vec3f> colors(rays.size(), Vec3f{0, 0, 0});
  for (size_t h = 0; h < hits.size(); ++h) colors[ray_of_hit[h]] = albedo[h];
  return colors;
}

Image base_color_picture(const Device& device, const Scene& scene, const Camera& camera) {
  const GBuffer traced = trace_view(device, scene, camera);
  const std::vector<Vec3f> albedo = appearance_at(device, scene, traced.hits).albedo;
  Image picture(traced.width, traced.height, 4);
  for (size_t pixel = 0; pixel + 1 < traced.pixel_start.size(); ++pixel) {
    const uint32_t begin = traced.pixel_start[pixel], end = traced.pixel_start[pixel + 1];
    if (begin == end) continue;
    Vec3f sum{0, 0, 0};
    for (uint32_t h = begin; h < end; ++h) sum += albedo[h];
    for (int c = 0; c < 3; ++c) picture.data[4 * pixel + c] = sum[c] / float(end - begin);
    picture.data[4 * pixel + 3] = float(end - begin) / float(traced.samples * traced.samples);
  }
  return picture;
}

}  // namespace cei3d
