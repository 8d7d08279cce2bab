// SPDX-License-Identifier: Apache-2.0
// Losses of the color of a surface sample: the appearance stage's, which is a Huber loss of display-encoded
// colors, and the paper's, which is L1 of linear radiance.
#pragma once

#include <algorithm>
#include <cmath>

#include "core/math/color.h"
#include "core/math/loss.h"
#include "core/math/shading.h"
#include "engine/reconstruct/appearance/linear_split.h"

namespace cei3d {

// Loss of one channel, with dL/d(radiance); radiance and photo are linear. The slope of the display curve is
// bounded near black. clipped: `photo` is only a lower bound of the true radiance.
inline LossValue<float> display_loss(float radiance, float photo, bool clipped = false) {
  constexpr float kWidth = 0.05f, kDarkest = 0.004f;
  if (clipped && radiance >= photo) return {0, 0};
  const LossValue<float> loss =
      huber(srgb_from_linear(std::max(radiance, 0.0f)) - srgb_from_linear(photo), kWidth);
  return {loss.value, loss.gradient * srgb_derivative(std::max(radiance, kDarkest))};
}
inline float display_loss_grad(float radiance, float photo, bool clipped = false) {
  return display_loss(radiance, photo, clipped).gradient;
}

// The same for the absolute error of linear radiance. [paper eq. 16]
inline LossValue<float> absolute_loss(float radiance, float photo, bool clipped = false) {
  if (clipped && radiance >= photo) return {0, 0};
  const float error = radiance - photo;
  return {std::abs(error), error > 0 ? 1.0f : -1.0f};
}

// Gradients of the loss of a surface sample, times `weight`.
struct SampleGrad {
  Vec3f d_radiance, d_albedo;
};
inline SampleGrad sample_grad(const SurfaceSamples& samples, uint32_t sample,
                              const ShadingTerms<float>& terms, Vec3f albedo, float weight) {
  const Vec3f radiance = terms.radiance(albedo), photo = samples.colors[sample];
  SampleGrad g;
  for (int c = 0; c < 3; ++c)
    g.d_radiance[c] = weight * display_loss_grad(radiance[c], photo[c], samples.is_clipped(sample, c));
  g.d_albedo = g.d_radiance * terms.gain();
  return g;
}

}  // namespace cei3d
