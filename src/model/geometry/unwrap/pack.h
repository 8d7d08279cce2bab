// SPDX-License-Identifier: Apache-2.0
// Flat pieces put into a square.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "core/math/vec2.h"

namespace cei3d {

struct FlatPiece {
  std::vector<Vec2d> points;
  std::vector<std::array<uint32_t, 3>> triangles;  // counter-clockwise
};

struct PackOptions {
  int size = 2048;  // texels of the square's side
  int between = 8;  // empty texels between pieces, at least
};

// The points of every piece in [0, 1]^2, turned and moved, all scaled by the same factor: the largest at
// which a place was found for each. Half of `between` stays empty along the rim of the square. Error: too
// many pieces for the square.
std::vector<std::vector<Vec2d>> packed(std::span<const FlatPiece> pieces, const PackOptions& options);

}  // namespace cei3d
