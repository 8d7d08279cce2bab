// SPDX-License-Identifier: Apache-2.0
// Distant light as a sum of spherical Gaussians. [paper eq. 12]
#pragma once

#include <span>
#include <vector>

#include "core/math/vec.h"

namespace cei3d {

struct SgLobe {
  Vec3f axis;    // unit, towards the light, capture frame
  float lambda;  // sharpness, > 0
  Vec3f mu;      // linear radiance at the peak, >= 0
};

// L(w) = sum_k mu_k exp(lambda_k (w . axis_k - 1))
struct SgMixture {
  std::vector<SgLobe> lobes;
};

// Range of lambda that shading in single precision can represent.
inline constexpr float kSharpestLobe = 20000, kBroadestLobe = 0.1f;

Vec3f radiance(const SgMixture& light, Vec3f direction);
SgMixture rotated(SgMixture light, const Mat3f& rotation);  // every axis becomes rotation * axis
SgMixture scaled(SgMixture light, Vec3f factor);

// Rows [M][7] of axis, lambda, mu, as in light files. Reading normalizes the axis and takes the absolute
// values of lambda and mu. Errors: no rows, rows of another length, values that are not finite, a zero axis.
std::vector<float> to_array(const SgMixture& light);
SgMixture light_from_array(std::span<const float> rows);

}  // namespace cei3d
