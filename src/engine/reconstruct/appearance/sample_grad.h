// SPDX-License-Identifier: Apache-2.0
// Gradients of the display loss of a surface sample.
#pragma once

#include "core/math/loss.h"
#include "core/math/shading.h"
#include "engine/reconstruct/appearance/linear_split.h"

namespace cei3d {

struct SampleGrad {
  Vec3f d_radiance, d_albedo;
};
// Times `weight`.
inline SampleGrad sample_grad(const SurfaceSamples& samples, uint32_t sample,
                              const ShadingTerms<float>& terms, Vec3f albedo, float weight) {
  const Vec3f radiance = terms.radiance(albedo), photo = samples.colors[sample];
  SampleGrad g;
  for (int c = 0; c < 3; ++c)
    g.d_radiance[c] = weight * display_loss(radiance[c], photo[c], samples.is_clipped(sample, c)).gradient;
  g.d_albedo = g.d_radiance * terms.gain();
  return g;
}

}  // namespace cei3d
