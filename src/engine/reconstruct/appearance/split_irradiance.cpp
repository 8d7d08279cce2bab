// SPDX-License-Identifier: Apache-2.0
#include "engine/reconstruct/appearance/split_irradiance.h"

#include <algorithm>
#include <cmath>

#include "core/base/parallel.h"
#include "core/math/color.h"
#include "model/light/envmap.h"

namespace cei3d {
namespace {

// Direct irradiance of every vertex: by bin, and the mean over them.
struct DirectLight {
  std::vector<std::vector<Vec3f>> by_bin;
  std::vector<Vec3f> mean;
};

DirectLight direct_light(const Transport& transport, const Image& light, const LightTurns* turns,
                         std::span<const uint8_t> which) {
  if (!turns) return {{}, transport.sky(sky_radiance(light), which)};
  DirectLight out;
  out.mean.assign(transport.surface().mesh().positions.size(), Vec3f{0, 0, 0});
  std::vector<SkyRadiance> skies;
  for (const Mat3f& room_from_object : turns->bins) skies.push_back(sky_radiance(light, room_from_object));
  out.by_bin = transport.skies(skies, which);
  for (const std::vector<Vec3f>& bin : out.by_bin)
    for (size_t v = 0; v < out.mean.size(); ++v) out.mean[v] += bin[v] / float(turns->bins.size());
  return out;
}

// Irradiance of every vertex from the surface. Metals count as diffuse emitters of their mean reflection.
std::vector<Vec3f> bounce_of(const Transport& transport, const SplitUnknowns& x,
                             const SplitMaterials& materials, const std::vector<Vec3f>& direct,
                             std::span<const uint8_t> which) {
  std::vector<Vec3f> emitted = x.diffuse;
  for (uint32_t v = 0; v < emitted.size(); ++v)
    if (materials.is_metal(v)) emitted[v] = materials.color[v] * direct[v] / kPi;
  return transport.bounce(emitted, which);
}

}  // namespace

Image light_image(const std::vector<Vec3f>& light, int height) {
  Image map(2 * height, height, 3);
  for (size_t i = 0; i < light.size(); ++i)
    for (int c = 0; c < 3; ++c) map.data[3 * i + c] = light[i][c];
  return map;
}

SkyRadiance sky_radiance(const Image& light, const Mat3f& room_from_object) {
  std::vector<Vec3f> sky;
  for (const Vec3f& d : sky_directions()) sky.push_back(room_from_object * d);
  SkyRadiance sum(sky.size(), Vec3f{0, 0, 0});
  std::vector<float> total(sky.size(), 0);
  // A cell contributes to the directions around it by a lobe about as wide as their spacing.
  for (int y = 0; y < light.height; ++y)
    for (int x = 0; x < light.width; ++x) {
      const Vec3f d = env_direction(float(x) + 0.5f, float(y) + 0.5f, light.width, light.height);
      const float area = env_solid_angle(y, light.width, light.height);
      for (size_t k = 0; k < sky.size(); ++k) {
        const float c = dot(d, sky[k]);
        if (c < 0.95f) continue;
        const float w = area * std::exp(256 * (c - 1));
        sum[k] += light.rgb(x, y) * w;
        total[k] += w;
      }
    }
  for (size_t k = 0; k < sky.size(); ++k) sum[k] = sum[k] / total[k];
  return sum;
}

std::vector<Vec3f> split_irradiance(const Transport& transport, const SplitUnknowns& x,
                                    const SplitMaterials& materials, int height, const LightTurns* turns,
                                    std::span<const uint8_t> which) {
  std::vector<Vec3f> out = direct_light(transport, light_image(x.light, height), turns, which).mean;
  const std::vector<Vec3f> bounce = bounce_of(transport, x, materials, out, which);
  for (size_t v = 0; v < out.size(); ++v) out[v] += bounce[v];
  return out;
}

namespace {

// Irradiance of every vertex from each harmonic of a light, without the bounce: #V.
std::vector<Harmonics> transfer_of(const Transport& transport, std::span<const uint8_t> which) {
  std::vector<Harmonics> out(transport.surface().mesh().positions.size());
  std::vector<SkyRadiance> skies(kHarmonics);
  for (const Vec3f& d : sky_directions())
    for (size_t j = 0; j < kHarmonics; ++j) skies[j].push_back(Vec3f{1, 1, 1} * harmonics(d)[j]);
  const std::vector<std::vector<Vec3f>> irradiance = transport.skies(skies, which);
  for (size_t v = 0; v < out.size(); ++v)
    for (size_t j = 0; j < kHarmonics; ++j) out[v][j] = irradiance[j][v].x;
  return out;
}

}  // namespace

TurningIrradiance::TurningIrradiance(const Transport& transport, const LightTurns& turns, int light_height,
                                     std::span<const uint8_t> which)
    : transport_(transport),
      turns_(turns),
      height_(light_height),
      which_(which),
      harmonics_(light_height),
      transfer_(transfer_of(transport, which)) {
  for (const Mat3f& rotation : turns.room_from_object) views_.push_back(turned_harmonics(rotation));
  for (const Mat3f& rotation : turns.bins) {
    const HarmonicMatrix& m = bins_.emplace_back(turned_harmonics(rotation));
    for (size_t i = 0; i < kHarmonics; ++i)
      for (size_t j = 0; j < kHarmonics; ++j) mean_[i][j] += m[i][j] / float(turns.bins.size());
  }
}

Harmonics TurningIrradiance::at(const SplitRow& row) const {
  Harmonics sum{};
  for (size_t k = 0; k < 3; ++k)
    for (size_t j = 0; j < kHarmonics; ++j) sum[j] += transfer_[row.vertices[k]][j] * row.barycentric[k];
  return sum;
}

TurningIrradiance::Turned TurningIrradiance::turn(const SplitUnknowns& x, const SplitMaterials& materials,
                                                  std::vector<SplitRow>& rows) const {
  const Vec3f dark{1e-6f, 1e-6f, 1e-6f};
  DirectLight light = direct_light(transport_, light_image(x.light, height_), &turns_, which_);
  const std::vector<Vec3f> bounce = bounce_of(transport_, x, materials, light.mean, which_);
  Turned out{{std::vector<DiffuseLightGrad::OfRow>(rows.size()), harmonics_.of(x.light)}, light.mean};
  for (size_t v = 0; v < bounce.size(); ++v) {
    out.irradiance[v] += bounce[v];
    light.mean[v] += bounce[v] + dark;
  }
  for (std::vector<Vec3f>& bin : light.by_bin)
    for (size_t v = 0; v < bin.size(); ++v) bin[v] = (bin[v] + bounce[v] + dark) / light.mean[v];
  parallel_ranges(int(rows.size()), 4096, [&](int begin, int end) {
    for (int i = begin; i < end; ++i) {
      SplitRow& row = rows[size_t(i)];
      const std::vector<Vec3f>& bin = light.by_bin[turns_.bin[row.view]];
      // From the bin's rotation to the view's by harmonics.
      const Harmonics here = at(row), in_view = views_[row.view] * here,
                      in_bin = bins_[turns_.bin[row.view]] * here, mean = mean_ * here;
      const Vec3f mean_light = at_corners(light.mean, row.vertices, row.barycentric),
                  more = (dot(in_view, out.grad.light) - dot(in_bin, out.grad.light)) / mean_light;
      row.diffuse_light = at_corners(bin, row.vertices, row.barycentric) + more;
      for (int c = 0; c < 3; ++c) row.diffuse_light[c] = max(row.diffuse_light[c], 0.0f);
      row.far_diffuse_light = at_corners(bin, row.far_vertices, row.far_barycentric);
      DiffuseLightGrad::OfRow& of_row = out.grad.rows[size_t(i)];
      const float share = luminance(row.diffuse_light);
      for (size_t j = 0; j < kHarmonics; ++j) of_row.d_light[j] = in_view[j] - share * mean[j];
      of_row.gain = at_corners(x.diffuse, row.vertices, row.barycentric) / mean_light;
    }
  });
  return out;
}

}  // namespace cei3d
