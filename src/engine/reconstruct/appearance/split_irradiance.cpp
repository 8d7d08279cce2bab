// SPDX-License-Identifier: Apache-2.0
#include "engine/reconstruct/appearance/split_irradiance.h"

#include <cmath>

namespace cei3d {
namespace {

// Direct irradiance of every vertex: by bin, and the mean over them.
struct DirectLight {
  std::vector<std::vector<Vec3f>> by_bin;
  std::vector<Vec3f> mean;
};

DirectLight direct_light(const Transport& transport, const Image& light, const LightTurns* turns) {
  if (!turns) return {{}, transport.sky(sky_radiance(light))};
  DirectLight out;
  out.mean.assign(transport.surface().mesh().positions.size(), Vec3f{0, 0, 0});
  for (const Mat3f& room_from_object : turns->bins) {
    out.by_bin.push_back(transport.sky(sky_radiance(light, room_from_object)));
    for (size_t v = 0; v < out.mean.size(); ++v)
      out.mean[v] += out.by_bin.back()[v] / float(turns->bins.size());
  }
  return out;
}

// Of every vertex from the surface, which sends out what it shows, metals as if their reflections were
// diffuse.
std::vector<Vec3f> bounce_of(const Transport& transport, const SplitUnknowns& x,
                             const SplitMaterials& materials, const std::vector<Vec3f>& direct) {
  std::vector<Vec3f> sent = x.diffuse;
  for (uint32_t v = 0; v < sent.size(); ++v)
    if (materials.is_metal(v)) sent[v] = materials.color[v] * direct[v] / kPi;
  return transport.bounce(sent);
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
  // A pixel feeds the directions around it by a narrow lobe about as wide as their spacing.
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
                                    const SplitMaterials& materials, int height, const LightTurns* turns) {
  std::vector<Vec3f> out = direct_light(transport, light_image(x.light, height), turns).mean;
  const std::vector<Vec3f> bounce = bounce_of(transport, x, materials, out);
  for (size_t v = 0; v < out.size(); ++v) out[v] += bounce[v];
  return out;
}

void turn_diffuse_light(const Transport& transport, const SplitUnknowns& x, const SplitMaterials& materials,
                        int height, const LightTurns& turns, float share, std::vector<SplitRow>& rows) {
  DirectLight light = direct_light(transport, light_image(x.light, height), &turns);
  const std::vector<Vec3f> bounce = bounce_of(transport, x, materials, light.mean);
  const Vec3f dark{1e-6f, 1e-6f, 1e-6f};
  for (std::vector<Vec3f>& bin : light.by_bin)
    for (size_t v = 0; v < bin.size(); ++v)
      bin[v] = (bin[v] + bounce[v] + dark) / (light.mean[v] + bounce[v] + dark);
  for (SplitRow& row : rows) {
    const std::vector<Vec3f>& bin = light.by_bin[row.light_bin];
    const auto move = [&](Vec3f& from, Vec3f to) { from = from * (1 - share) + to * share; };
    move(row.diffuse_light, between(bin, row.vertices, row.barycentric));
    if (row.blocked) move(row.far_diffuse_light, between(bin, row.far_vertices, row.far_barycentric));
  }
}

}  // namespace cei3d
