// SPDX-License-Identifier: Apache-2.0
// What light and material make of surface samples, and how far it is from their photographs.
#pragma once

#include <span>
#include <vector>

#include "core/base/progress.h"
#include "engine/reconstruct/appearance/linear_split.h"
#include "engine/render/lighting.h"
#include "model/scene/scene.h"

namespace cei3d {

// Mean albedo of the pixels of hits: at pixel centers the texture is sharper than the image, and what is
// fitted to the difference would learn to blur it. footprints: #hits, or empty: of points.
std::vector<Vec3f> pixel_colors(const Device&, const Field& albedo, std::span<const Hit> hits,
                                std::span<const float> footprints);

// Light and material of a scene, made ready once to shade many samples, without the correction.
class SampleShader {
 public:
  // turns: of the samples' views; null: the light stands still. Scene and turns must outlive the object.
  // transport: of the scene's surface, or null. Error: interrupted.
  SampleShader(const Device&, const Scene&, const LightTurns* turns, const Progress&,
               const Transport* transport = nullptr);
  // Linear radiance: #samples. Error: interrupted.
  std::vector<Vec3f> radiance(const SurfaceSamples&, const Progress&) const;

 private:
  const Device& device_;
  const Scene& scene_;
  Lighting light_;
};
// The same for one use.
std::vector<Vec3f> radiance_of(const Device&, const Scene&, const SurfaceSamples&, const Progress&);

// Squared error of a displayed pixel, summed over its channels. radiance, photo: linear; a display shows no
// more than 1.
double display_error(Vec3f radiance, Vec3f photo);
// PSNR (dB) of some samples as they are displayed; finite for equal colors, too. which: their indices.
// radiance: #which, linear.
double display_psnr(const SurfaceSamples&, std::span<const uint32_t> which, std::span<const Vec3f> radiance);

}  // namespace cei3d
