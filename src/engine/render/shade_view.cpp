// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>

#include "core/base/parallel.h"
#include "engine/render/render.h"
#include "engine/render/scene_light.h"
#include "model/scene/appearance.h"

namespace cei3d {

namespace {

Frame empty_frame(int width, int height) {
  Frame f;
  for (Image* i : {&f.rgb, &f.albedo, &f.diffuse, &f.specular}) *i = Image(width, height, 4);
  f.normal = Image(width, height, 3);
  for (Image* i : {&f.depth, &f.roughness, &f.mask}) *i = Image(width, height, 1);
  f.edited.assign(size_t(width) * height, 0);
  return f;
}

float tent(float distance) { return std::max(0.0f, 1 - std::abs(distance)); }

// Weight of sample `k` (of `samples` along an axis) of the pixel `offset` pixels away.
float axis_weight(int offset, int k, int samples) {
  return tent(float(offset) + (float(k) + 0.5f) / float(samples) - 0.5f);
}

// Sum of the weights along an axis that has `size` pixels: less than in the middle at the frame's border.
float axis_total(int at, int size, int samples) {
  float sum = 0;
  for (int offset = -1; offset <= 1; ++offset)
    if (at + offset >= 0 && at + offset < size)
      for (int k = 0; k < samples; ++k) sum += axis_weight(offset, k, samples);
  return sum;
}

// Calls visit(hit, weight) for the hits around pixel (x, y), in a fixed order.
template <class F>
void for_hits_around(const GBuffer& g, int x, int y, F visit) {
  for (int qy = std::max(0, y - 1); qy <= std::min(g.height - 1, y + 1); ++qy)
    for (int qx = std::max(0, x - 1); qx <= std::min(g.width - 1, x + 1); ++qx) {
      const size_t q = size_t(qy) * g.width + qx;
      for (uint32_t i = g.pixel_start[q]; i < g.pixel_start[q + 1]; ++i) {
        const int sub = g.sub_pixels[i];
        const float w =
            axis_weight(qx - x, sub % g.samples, g.samples) * axis_weight(qy - y, sub / g.samples, g.samples);
        if (w > 0) visit(i, w);
      }
    }
}

void put_mean(Image& image, size_t pixel, Vec3f sum, float weight, float coverage) {
  const Vec3f mean = sum / weight;
  for (int c = 0; c < 3; ++c) image.data[4 * pixel + c] = mean[c];
  image.data[4 * pixel + 3] = coverage;
}

// The residual of what is as it was photographed; else nothing. #hits
std::vector<Vec3f> residuals(const Device& device, const Scene& scene, const Appearance& look,
                             std::span<const Hit> hits) {
  std::vector<Vec3f> out(hits.size(), Vec3f{0, 0, 0});
  if (!scene.residual) return out;
  std::vector<Hit> original;
  std::vector<size_t> of;
  for (size_t i = 0; i < hits.size(); ++i)
    if (look.original[i] > 0) {
      original.push_back(hits[i]);
      of.push_back(i);
    }
  const std::vector<Vec3f> values = residual_at(device, *scene.residual, original);
  for (size_t k = 0; k < of.size(); ++k) out[of[k]] = values[k] * look.original[of[k]];
  return out;
}

Vec3f sent(const Shading& shading, const std::vector<Vec3f>& residual, size_t hit) {
  const Vec3f sum = shading.diffuse[hit] + shading.specular[hit] + residual[hit];
  return {std::max(sum.x, 0.0f), std::max(sum.y, 0.0f), std::max(sum.z, 0.0f)};
}

}  // namespace

Frame shade_view(const Device& device, const Scene& scene, const SceneLight& light, const GBuffer& g) {
  const Appearance look = appearance_at(device, scene, g.hits);
  const Shading shading = light.shade(g.hits, look);
  const std::vector<Vec3f> residual = residuals(device, scene, look, g.hits);
  Frame f = empty_frame(g.width, g.height);
  parallel_for(g.height, [&](int y) {
    for (int x = 0; x < g.width; ++x) {
      const size_t p = size_t(y) * g.width + x;
      Vec3f albedo{0, 0, 0}, diffuse{0, 0, 0}, specular{0, 0, 0}, normal{0, 0, 0}, rgb{0, 0, 0};
      float depth = 0, roughness = 0, weight = 0;
      for_hits_around(g, x, y, [&](uint32_t i, float w) {
        albedo += w * look.albedo[i];
        diffuse += w * shading.diffuse[i];
        specular += w * shading.specular[i];
        rgb += w * sent(shading, residual, i);
        normal += w * g.hits[i].normal;
        depth += w * g.depths[i];
        roughness += w * look.materials[look.material[i]].roughness;
        weight += w;
        f.edited[p] |= look.layer[i] >= 0;
      });
      if (weight == 0) continue;
      const float coverage =
          std::min(1.0f, weight / (axis_total(x, g.width, g.samples) * axis_total(y, g.height, g.samples)));
      put_mean(f.albedo, p, albedo, weight, coverage);
      put_mean(f.diffuse, p, diffuse, weight, coverage);
      put_mean(f.specular, p, specular, weight, coverage);
      put_mean(f.rgb, p, rgb, weight, coverage);
      const Vec3f n = normalize(normal);
      for (int c = 0; c < 3; ++c) f.normal.data[3 * p + c] = n[c];
      f.depth.data[p] = depth / weight / float(scene.normalization.scale);
      f.roughness.data[p] = roughness / weight;
      f.mask.data[p] = coverage;
    }
  });
  return f;
}

Frame shade_view(const Device& device, const Scene& scene, const GBuffer& g) {
  return shade_view(device, scene, SceneLight(device, scene, scene_transports(scene)), g);
}

}  // namespace cei3d
