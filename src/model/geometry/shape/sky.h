// SPDX-License-Identifier: Apache-2.0
// The directions in which surfaces look for the sky.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "core/math/vec.h"

namespace cei3d {

inline constexpr int kSkyDirections = 512;  // directions a visibility row has bits for

// Fixed set of near-uniform directions (spherical Fibonacci), the columns of a visibility table.
const std::vector<Vec3f>& sky_directions();

// Those around a direction (unit): the nearest of them among others about as near.
using SkyNeighbors = std::array<uint16_t, 4>;
const SkyNeighbors& sky_around(Vec3f direction);

}  // namespace cei3d
