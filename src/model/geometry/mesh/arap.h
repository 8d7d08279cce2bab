// SPDX-License-Identifier: Apache-2.0
// Deformation of a mesh by a dragged handle: every vertex and its neighbors move as rigidly as the handle
// allows.
//
//   E(p, R) = sum_i sum_j w_ij |p_i - p_j - R_i (q_i - q_j)|^2  +  b^2 sum_i |d_i(p) - R_i d_i(q)|^2 / A_i
//
// with q the mesh as it was, p as it becomes, R_i a rotation for each vertex, w_ij cotangent weights, A_i
// areas and d_i(p) = sum_j w_ij (p_i - p_j). The first term is [Sorkine and Alexa 2007]. Alone it behaves
// like a membrane: a spike at a small handle and a crease where the fixed part begins. The second term
// resists bending over distances up to b, which leaves tangents continuous at both.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "core/math/vec.h"

namespace cei3d {

struct ArapConstraints {
  std::vector<uint8_t> free;      // #V, 1: goes where the energy is least. Others stay where they are ...
  std::vector<uint32_t> handles;  // ... but for these, not free, which go to
  std::vector<Vec3f> targets;     // #handles
};

struct ArapOptions {
  float bending_length = 0;  // b, in units of the positions
  int most_iterations = 60;
  double tolerance = 1e-4;  // stops when an iteration lowers the energy by less than this share
};

struct ArapResult {
  std::vector<Vec3f> positions;  // #V; vertices that are neither free nor handles bit-identical
  std::vector<double> energies;  // after each iteration; never rises
};

// Local-global descent: rotations by Procrustes, positions by one linear system factorized once. Its time
// follows the number of free vertices. Free vertices that no way along the mesh joins to one that is held
// stay. Same input, same bits.
ArapResult arap_deform(std::span<const Vec3f> positions, std::span<const std::array<uint32_t, 3>> triangles,
                       const ArapConstraints&, const ArapOptions&);

}  // namespace cei3d
