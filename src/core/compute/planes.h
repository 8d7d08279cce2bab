// SPDX-License-Identifier: Apache-2.0
// Vectors as the planes that kernels read and write.
#pragma once

#include <span>
#include <vector>

#include "core/math/vec.h"

namespace cei3d {

// [3][stride]; zeros behind the vectors. stride: at least v.size().
std::vector<float> planes_of(std::span<const Vec3f> v, int stride);
// The first n vectors of planes [3][stride].
std::vector<Vec3f> vectors_of(std::span<const float> planes, int stride, size_t n);

}  // namespace cei3d
