// SPDX-License-Identifier: Apache-2.0
// The visibility of the sky from the vertices of a surface as polynomials of the direction, which graphics
// hardware evaluates at every pixel.
#pragma once

#include <array>
#include <vector>

#include "engine/view/pack.h"
#include "model/geometry/shape/surface.h"

namespace cei3d {

// Coefficients of 1; y, z, x; xy, yz, 3z^2 - 1, xz, x^2 - y^2: the first three bands of spherical harmonics
// with their constants. The sum is about 1 where the sky is visible and 0 where it is blocked.
inline constexpr size_t kVisibilityTerms = 9;
using VisibilityTerms = std::array<float, kVisibilityTerms>;

VisibilityTerms visibility_basis(Vec3f direction);  // 1, y, z, ...

// #V. Below the horizon of a vertex, where nothing is reflected, the sky counts as visible to the share that
// is visible above.
std::vector<VisibilityTerms> visibility_harmonics(const Surface& surface);

// Adds "visibility", i8 [#terms, 12] in units of the head's visibility_scale; the last columns are 0.
void add_visibility(const std::vector<VisibilityTerms>&, Pack&);

}  // namespace cei3d
