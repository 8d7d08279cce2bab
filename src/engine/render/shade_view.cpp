// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <vector>

#include "core/base/parallel.h"
#include "core/math/sub_pixel.h"
#include "engine/render/hit_memory.h"
#include "engine/render/render.h"
#include "engine/render/scene_light.h"
#include "model/scene/appearance.h"

namespace cei3d {

namespace {

Frame empty_frame(int width, int height) {
  Frame f;
  for (Image* i : {&f.rgb, &f.albedo, &f.diffuse, &f.specular}) *i = Image(width, height, 4);
  f.normal = Image(width, height, 3);
  for (Image* i : {&f.depth, &f.roughness, &f.metalness, &f.mask}) *i = Image(width, height, 1);
  f.edited.assign(size_t(width) * height, 0);
  return f;
}

// Weights of the samples of a pixel and its eight neighbors in the pixel.
class PixelFilter {
 public:
  explicit PixelFilter(const GBuffer& g) : g_(g) {
    for (const uint8_t samples : g.samples)
      if (grids_[samples].empty()) grids_[samples] = weights(samples);
  }

  // Calls visit(hit, weight) for the hits around pixel (x, y), in a fixed order. Returns the weight of all
  // samples there, also those that missed.
  template <class F>
  float visit_hits(int x, int y, F visit) const {
    float total = 0;
    for (int qy = std::max(0, y - 1); qy <= std::min(g_.height - 1, y + 1); ++qy)
      for (int qx = std::max(0, x - 1); qx <= std::min(g_.width - 1, x + 1); ++qx) {
        const size_t q = size_t(qy) * g_.width + qx;
        const Grid& grid = grids_[g_.samples[q]][size_t(3 * (qy - y + 1) + qx - x + 1)];
        total += grid.sum;
        for (uint32_t i = g_.pixel_start[q]; i < g_.pixel_start[q + 1]; ++i)
          if (const float w = grid.weight[g_.sub_pixels[i]]; w > 0) visit(i, w);
      }
    return total;
  }

 private:
  struct Grid {
    std::vector<float> weight;  // #samples of a pixel
    float sum = 0;
  };

  // Weights of the samples of the nine pixels, row by row; each pixel's share of the image is the same.
  static std::vector<Grid> weights(int samples) {
    std::vector<Grid> out(9);
    for (int q = 0; q < 9; ++q)
      for (int k = 0; k < samples * samples; ++k) {
        const Vec2f p = sub_pixel(k, samples);
        const float w = tent_weight({float(q % 3) + p.x - 1.5f, float(q / 3) + p.y - 1.5f});
        out[q].weight.push_back(w / float(samples * samples));
        out[q].sum += out[q].weight.back();
      }
    return out;
  }

  const GBuffer& g_;
  std::array<std::vector<Grid>, 256> grids_;  // by samples along an axis; empty: none has so many
};

void put_mean(Image& image, size_t pixel, Vec3f sum, float weight, float coverage) {
  const Vec3f mean = sum / weight;
  for (int c = 0; c < 3; ++c) image.data[4 * pixel + c] = mean[c];
  image.data[4 * pixel + 3] = coverage;
}

// Evaluates the correction where it is wanted and not known.
void fill_residuals(const Device& device, const Residual& residual, std::span<const Hit> hits,
                    std::span<const uint8_t> wanted, bool smooth, SomeValues& out) {
  out.values.resize(hits.size(), Vec3f{0, 0, 0});
  out.known.resize(hits.size(), 0);
  std::vector<Hit> some;
  std::vector<size_t> of;
  for (size_t i = 0; i < hits.size(); ++i)
    if (wanted[i] && !out.known[i]) {
      some.push_back(hits[i]);
      of.push_back(i);
    }
  const std::vector<Vec3f> values = residual_at(device, residual, some, smooth);
  for (size_t k = 0; k < of.size(); ++k) {
    out.values[of[k]] = values[k];
    out.known[of[k]] = 1;
  }
}

// Hits that an edit's color covers get a correction without details as well: details belong to the surface
// that was photographed.
void fill_residuals(const Device& device, const Scene& scene, const Appearance& look,
                    std::span<const Hit> hits, HitMemory& memory) {
  if (memory.residual != scene.residual || memory.residuals.known.size() != hits.size()) {
    memory.residual = scene.residual;
    memory.residuals = memory.smooth_residuals = {};
  }
  const std::vector<uint8_t>& in_place = look.photographed.in_place;
  fill_residuals(device, *scene.residual, hits, in_place, false, memory.residuals);
  if (look.covered.empty()) return;
  std::vector<uint8_t> covered(hits.size());
  for (size_t i = 0; i < hits.size(); ++i) covered[i] = in_place[i] && look.covered[i] > 0;
  fill_residuals(device, *scene.residual, hits, covered, true, memory.smooth_residuals);
}

// Radiance of the hits as they were photographed, under the present light. hits: indices.
std::vector<Vec3f> photographed_radiance(const SceneLight& light, std::span<const Hit> all,
                                         const Appearance& look, std::span<const size_t> hits) {
  std::vector<Hit> some;
  Appearance before;
  for (const size_t i : hits) {
    some.push_back(all[i]);
    before.albedo.push_back(look.photographed.albedo[i]);
    before.material.push_back(look.photographed.material[i]);
    before.layer.push_back(look.layer[i]);
  }
  const Shading shading = light.shade(some, before);
  std::vector<Vec3f> out(hits.size());
  for (size_t k = 0; k < out.size(); ++k) out[k] = shading.diffuse[k] + shading.specular[k];
  return out;
}

// What an edit leaves of the correction: it is a share of the radiance that light and material explain, and
// stays that share where they change. Where they become much brighter it stays behind, because the errors of
// a dark surface say little about a bright one.
float kept_share(float now, float before) {
  constexpr float kMax = 2, kBlack = 1e-4f;
  return std::clamp((now + kBlack) / (before + kBlack), 0.0f, kMax);
}

// The correction, carried over to the edited surface: #hits, linear radiance.
std::vector<Vec3f> residuals(const Device& device, const Scene& scene, const SceneLight& light,
                             const Shading& shading, std::span<const Hit> hits, HitMemory& memory) {
  std::vector<Vec3f> out(hits.size(), Vec3f{0, 0, 0});
  if (!scene.residual) return out;
  const Appearance& look = memory.lit->look;
  fill_residuals(device, scene, look, hits, memory);
  std::vector<size_t> edited;
  for (size_t i = 0; i < hits.size(); ++i) {
    if (!look.photographed.in_place[i]) continue;
    out[i] = memory.residuals.values[i];
    const Vec3f a = look.albedo[i], b = look.photographed.albedo[i];
    const bool same =
        a.x == b.x && a.y == b.y && a.z == b.z && look.material[i] == look.photographed.material[i];
    if (!same) edited.push_back(i);
  }
  const std::vector<Vec3f> before = photographed_radiance(light, hits, look, edited);
  for (size_t k = 0; k < edited.size(); ++k) {
    const size_t i = edited[k];
    const Vec3f now = shading.diffuse[i] + shading.specular[i];
    if (const float share = look.covered.empty() ? 0 : look.covered[i]; share > 0)
      out[i] = (1 - share) * out[i] + share * memory.smooth_residuals.values[i];
    for (int c = 0; c < 3; ++c) out[i][c] *= kept_share(now[c], before[k][c]);
    if (!look.unlit.empty()) out[i] = out[i] * (1 - look.unlit[i]);
  }
  return out;
}

Appearance appearance(const Device& device, const Scene& scene, std::span<const Hit> hits,
                      const HitMemory& memory) {
  if (!memory.lit || !memory.shown) return appearance_at(device, scene, hits);
  return appearance_after(device, scene, hits, *memory.shown, memory.lit->look);
}

// The hits of a view, shaded.
struct ShadedHits {
  const GBuffer& g;
  const Appearance& look;
  const Shading& shading;
  std::vector<Vec3f> residual;

  Vec3f radiance(size_t hit) const {
    const Vec3f sum = shading.diffuse[hit] + shading.specular[hit] + residual[hit];
    return {std::max(sum.x, 0.0f), std::max(sum.y, 0.0f), std::max(sum.z, 0.0f)};
  }
};

// unit_scale: a length in the unit frame over that in the capture frame.
void put_pixel(const ShadedHits& s, const PixelFilter& filter, int x, int y, float unit_scale, Frame& f) {
  const size_t p = size_t(y) * s.g.width + x;
  Vec3f albedo{0, 0, 0}, diffuse{0, 0, 0}, specular{0, 0, 0}, normal{0, 0, 0}, rgb{0, 0, 0};
  float depth = 0, roughness = 0, metalness = 0, weight = 0;
  const float total = filter.visit_hits(x, y, [&](uint32_t i, float w) {
    albedo += w * s.look.albedo[i];
    diffuse += w * s.shading.diffuse[i];
    specular += w * s.shading.specular[i];
    rgb += w * s.radiance(i);
    normal += w * s.g.hits[i].normal;
    depth += w * s.g.depths[i];
    roughness += w * s.look.material[i].roughness;
    metalness += w * s.look.material[i].metalness;
    weight += w;
    f.edited[p] |= s.look.layer[i] >= 0;
  });
  if (weight == 0) return;
  const float coverage = std::min(1.0f, weight / total);
  put_mean(f.albedo, p, albedo, weight, coverage);
  put_mean(f.diffuse, p, diffuse, weight, coverage);
  put_mean(f.specular, p, specular, weight, coverage);
  put_mean(f.rgb, p, rgb, weight, coverage);
  const Vec3f n = normalize(normal);
  for (int c = 0; c < 3; ++c) f.normal.data[3 * p + c] = n[c];
  f.depth.data[p] = depth / weight / unit_scale;
  f.roughness.data[p] = roughness / weight;
  f.metalness.data[p] = metalness / weight;
  f.mask.data[p] = coverage;
}

}  // namespace

Frame shade_view(const Device& device, const Scene& scene, const SceneLight& light, const GBuffer& g,
                 HitMemory& memory) {
  memory.lit = light.light_hits(g.hits, appearance(device, scene, g.hits, memory),
                                memory.lit ? &*memory.lit : nullptr);
  memory.shown.emplace(scene);
  const Shading shading = memory.lit->shading();
  const ShadedHits shaded{g, memory.lit->look, shading,
                          residuals(device, scene, light, shading, g.hits, memory)};
  const PixelFilter filter(g);
  Frame f = empty_frame(g.width, g.height);
  parallel_for(g.height, [&](int y) {
    for (int x = 0; x < g.width; ++x) put_pixel(shaded, filter, x, y, float(scene.normalization.scale), f);
  });
  return f;
}

Image filtered_albedo(const GBuffer& g, std::span<const Vec3f> albedo) {
  const PixelFilter filter(g);
  Image out(g.width, g.height, 4);
  parallel_for(g.height, [&](int y) {
    for (int x = 0; x < g.width; ++x) {
      Vec3f sum{0, 0, 0};
      float weight = 0;
      const float total = filter.visit_hits(x, y, [&](uint32_t i, float w) {
        sum += w * albedo[i];
        weight += w;
      });
      if (weight > 0) put_mean(out, size_t(y) * g.width + x, sum, weight, std::min(1.0f, weight / total));
    }
  });
  return out;
}

Frame shade_view(const Device& device, const Scene& scene, const SceneLight& light, const GBuffer& g) {
  HitMemory none;
  return shade_view(device, scene, light, g, none);
}

Frame shade_view(const Device& device, const Scene& scene, const GBuffer& g) {
  return shade_view(device, scene, SceneLight(device, scene, scene_transports(scene)), g);
}

}  // namespace cei3d
