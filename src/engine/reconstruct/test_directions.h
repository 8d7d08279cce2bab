// SPDX-License-Identifier: Apache-2.0
// For tests of gradients against differences.
#pragma once

#include <cmath>
#include <span>
#include <vector>

#include "core/math/rng.h"

namespace cei3d {

// A direction in the space of a tensor: random, but mostly along its gradient, which otherwise drowns.
// gradient: without the padding of Param.
struct TensorDirection {
  std::vector<float> of;
  double slope = 0;  // derivative along the direction, by the gradient

  TensorDirection(std::span<const float> gradient, uint64_t seed) : of(gradient.begin(), gradient.end()) {
    double squares = 0;
    for (const float g : gradient) squares += double(g) * g;
    const double scale = std::sqrt(squares / double(gradient.size()));
    for (size_t i = 0; i < of.size(); ++i) {
      of[i] = (of[i] + float(0.5 * scale) * Rng(9, seed, i).normal()) / float(std::sqrt(squares));
      slope += double(of[i]) * gradient[i];
    }
  }
};

}  // namespace cei3d
