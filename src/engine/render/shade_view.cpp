// SPDX-License-Identifier: Apache-2.0
#include <algorithm>

#include "core/base/parallel.h"
#include "engine/render/lighting.h"
#include "engine/render/render.h"
#include "model/scene/dual_albedo.h"

namespace cei3d {

namespace {

Frame empty_frame(int width, int height) {
  Frame f;
  for (Image* i : {&f.rgb, &f.albedo, &f.diffuse, &f.specular}) *i = Image(width, height, 4);
  f.normal = Image(width, height, 3);
  f.depth = Image(width, height, 1);
  f.mask = Image(width, height, 1);
  f.edited.assign(size_t(width) * height, 0);
  return f;
}

void put_mean(Image& image, size_t pixel, Vec3f sum, float hits, float coverage) {
  const Vec3f mean = sum / hits;
  for (int c = 0; c < 3; ++c) image.data[4 * pixel + c] = mean[c];
  image.data[4 * pixel + 3] = coverage;
}

}  // namespace

std::shared_ptr<const Lighting> light_scene(const Device& device, const Scene& scene) {
  const auto& positions = scene.surface->mesh().positions;
  std::vector<float> values(positions.size() * 3);
  scene.albedo->eval(device, positions, values);
  std::vector<Vec3f> albedo(positions.size());
  for (size_t v = 0; v < albedo.size(); ++v) albedo[v] = {values[3 * v], values[3 * v + 1], values[3 * v + 2]};
  return std::make_shared<const Lighting>(device, *scene.surface, scene.light, albedo, scene.material);
}

Frame shade_view(const Device& device, const Scene& scene, const Lighting& lighting, const GBuffer& g) {
  const RoutedAlbedo routed = routed_albedo(device, *scene.albedo, scene.layers, g.hits);
  const Shading shading = lighting.shade(g.hits, routed.albedo);
  Frame f = empty_frame(g.width, g.height);
  const float samples = float(g.samples * g.samples);
  parallel_ranges(g.width * g.height, 4096, [&](int begin, int end) {
    for (int p = begin; p < end; ++p) {
      const uint32_t first = g.pixel_start[p], last = g.pixel_start[p + 1];
      if (first == last) continue;
      Vec3f albedo{0, 0, 0}, diffuse{0, 0, 0}, specular{0, 0, 0}, normal{0, 0, 0};
      float depth = 0;
      for (uint32_t i = first; i < last; ++i) {
        albedo += routed.albedo[i];
        diffuse += shading.diffuse[i];
        specular += shading.specular[i];
        normal += g.hits[i].normal;
        depth += g.depths[i];
        f.edited[p] |= routed.layer[i] >= 0;
      }
      const float hits = float(last - first), coverage = hits / samples;
      put_mean(f.albedo, p, albedo, hits, coverage);
      put_mean(f.diffuse, p, diffuse, hits, coverage);
      put_mean(f.specular, p, specular, hits, coverage);
      put_mean(f.rgb, p, diffuse + specular, hits, coverage);
      const Vec3f n = normalize(normal);
      for (int c = 0; c < 3; ++c) f.normal.data[3 * size_t(p) + c] = n[c];
      f.depth.data[p] = depth / hits / float(scene.normalization.scale);
      f.mask.data[p] = coverage;
    }
  });
  return f;
}

Frame shade_view(const Device& device, const Scene& scene, const GBuffer& g) {
  return shade_view(device, scene, *light_scene(device, scene), g);
}

}  // namespace cei3d
