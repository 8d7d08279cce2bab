// SPDX-License-Identifier: Apache-2.0
#include "engine/reconstruct/appearance/shaded_samples.h"

#include <algorithm>
#include <optional>

#include "core/base/cancel.h"
#include "core/math/color.h"
#include "core/math/psnr.h"
#include "engine/reconstruct/appearance/pixel_points.h"
#include "engine/render/lighting.h"

namespace cei3d {

std::vector<Vec3f> pixel_colors(const Device& device, const Field& albedo, std::span<const Hit> hits,
                                std::span<const float> footprints) {
  std::vector<Vec3f> points, out(hits.size(), Vec3f{0, 0, 0});
  for (size_t i = 0; i < hits.size(); ++i)
    for (const Vec3f p : pixel_points(hits[i], footprints.empty() ? 0 : footprints[i])) points.push_back(p);
  const std::vector<Vec3f> values = albedo.eval3(device, points);
  for (size_t k = 0; k < points.size(); ++k) out[k / kPixelPoints] += values[k] / float(kPixelPoints);
  return out;
}

namespace {

Lighting lighting_of(const Device& device, const Scene& scene, const LightTurns* turns,
                     const Transport* transport, const Progress& progress) {
  std::optional<Transport> own;
  if (!transport) transport = &own.emplace(scene.surface, std::vector<uint8_t>(), progress);
  const std::vector<Vec3f>& vertices = scene.surface->mesh().positions;
  return Lighting(device, scene.surface, scene.light,
                  turned_vertex_lights(
                      *transport, scene.light,
                      {scene.albedo->eval3(device, vertices), scene.material.at(device, vertices)}, turns));
}

}  // namespace

SampleShader::SampleShader(const Device& device, const Scene& scene, const LightTurns* turns,
                           const Progress& progress, const Transport* transport)
    : device_(device), scene_(scene), light_(lighting_of(device, scene, turns, transport, progress)) {}

std::vector<Vec3f> SampleShader::radiance(const SurfaceSamples& samples, const Progress& progress) const {
  // Number of hits between two checks for interruption: 5 s with the largest networks.
  constexpr size_t kSlab = 1 << 15;
  std::vector<Vec3f> out;
  out.reserve(samples.hits.size());
  for (size_t begin = 0; begin < samples.hits.size(); begin += kSlab) {
    check_cancelled(progress);
    const size_t n = std::min(kSlab, samples.hits.size() - begin);
    const std::span<const Hit> hits = samples.hits.subspan(begin, n);
    const std::vector<Material> materials = scene_.material.at(device_, positions_of(hits));
    const std::vector<Vec3f> albedo =
        pixel_colors(device_, *scene_.albedo, hits,
                     samples.footprints.empty() ? samples.footprints : samples.footprints.subspan(begin, n));
    const Shading shading = light_.shade({hits, materials, samples.turned.part(begin, n)}, albedo);
    for (size_t i = 0; i < n; ++i) out.push_back(shading.diffuse[i] + shading.specular[i]);
  }
  return out;
}

std::vector<Vec3f> radiance_of(const Device& device, const Scene& scene, const SurfaceSamples& samples,
                               const Progress& progress) {
  return SampleShader(device, scene, samples.turned.turns, progress).radiance(samples, progress);
}

double display_error(Vec3f radiance, Vec3f photo) {
  double sum = 0;
  for (int c = 0; c < 3; ++c)
    sum += square(srgb_from_linear(clamp(radiance[c], 0.0f, 1.0f)) - srgb_from_linear(min(photo[c], 1.0f)));
  return sum;
}

double display_psnr(const SurfaceSamples& samples, std::span<const uint32_t> which,
                    std::span<const Vec3f> radiance) {
  double sum = 1e-12;
  for (size_t k = 0; k < which.size(); ++k) sum += display_error(radiance[k], samples.colors[which[k]]);
  return psnr_of_mse(sum / (3 * double(std::max<size_t>(which.size(), 1))));
}

}  // namespace cei3d
