// SPDX-License-Identifier: Apache-2.0
// How bright single photographs are, against what light and material explain.
// docs/method.md#exposures-that-differ
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "core/math/vec.h"

namespace cei3d {

// A sample of a photograph, and what light and material make of it. Linear.
struct ComparedSample {
  Vec3f position;  // unit frame
  uint16_t view;
  Vec3f photo, radiance;
};

// The factor by which each photograph is brighter than its radiance everywhere: the surface is divided into
// parts, and a factor is the median over them, so that a part that is explained badly does not count. What a
// part has in all photographs is its own. Without clipped and nearly black samples. #views; their logarithms
// have a mean of 0; 1 where a photograph shows too little.
std::vector<float> view_brightness(std::span<const ComparedSample>, size_t views);

}  // namespace cei3d
