// SPDX-License-Identifier: Apache-2.0
// A piece of surface laid flat.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "core/math/vec2.h"

namespace cei3d {

// A piece of surface with its own vertices: corners that meet in a vertex of the mesh, but are not connected
// by faces of the piece around it, are different ones.
struct Patch2d {
  std::vector<Vec3f> points;                       // #V
  std::vector<std::array<uint32_t, 3>> triangles;  // #F
  Vec3f axis{0, 0, 0};                             // unit, its mean normal
};

// The least-squares conformal map [Levy et al. 2002]: angles change as little as they can, the border is
// free. Its area is that of the piece. Triangles are counter-clockwise, y up, unless they are flipped. patch:
// one piece connected by edges.
std::vector<Vec2d> conformal_map(const Patch2d& patch);

// The orthogonal projection of the piece along its axis, scaled to the area of the piece.
std::vector<Vec2d> projection(const Patch2d& patch);

struct Stretch {
  bool flipped = false;  // a triangle that has an area lies upside down or has none any more
  double l2 = 1;         // root mean square of the singular values of texture -> surface; 1: isometric
};
// [Sander et al. 2001], with the scale that gives both the same area.
Stretch stretch_of(const Patch2d& patch, std::span<const Vec2d> uv);

}  // namespace cei3d
