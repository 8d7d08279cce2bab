// SPDX-License-Identifier: Apache-2.0
// Distant light as a sum of spherical Gaussians. [paper eq. 3; reference-facts 3.2]
#pragma once

#include <vector>

#include "core/math/vec.h"

namespace cei3d {

struct SgLobe {
  Vec3f axis;    // unit, towards the light, capture's axes
  float lambda;  // sharpness, > 0
  Vec3f mu;      // linear radiance at the peak, >= 0
};

// L(w) = sum_k mu_k exp(lambda_k (w . axis_k - 1))
struct SgMixture {
  std::vector<SgLobe> lobes;
};

}  // namespace cei3d
