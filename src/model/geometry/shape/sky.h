// SPDX-License-Identifier: Apache-2.0
// Fixed directions of the visibility table.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "core/math/vec.h"

namespace cei3d {

inline constexpr int kSkyDirections = 512;  // bits per vertex of the visibility table

// Near-uniform directions (spherical Fibonacci), the columns of a visibility table.
const std::vector<Vec3f>& sky_directions();

// Indices of the 4 sky directions nearest to a unit direction; approximate, by cells of the octahedral map.
using SkyNeighbors = std::array<uint16_t, 4>;
const SkyNeighbors& sky_around(Vec3f direction);

}  // namespace cei3d
