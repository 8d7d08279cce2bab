// SPDX-License-Identifier: Apache-2.0
// As-rigid-as-possible deformation of a mesh by dragged handles. Minimizes
//
//   E(p, R) = sum_i sum_j w_ij |p_i - p_j - R_i (q_i - q_j)|^2  +  b^2 sum_i |d_i(p) - R_i d_i(q)|^2 / A_i
//
// over positions p and rotations R_i of the vertices: q are the positions before, w_ij cotangent weights, A_i
// vertex areas and d_i(p) = sum_j w_ij (p_i - p_j). The first term is that of [Sorkine and Alexa 2007]. Alone
// it behaves like a membrane: a spike at a small handle and a crease where the fixed region begins. The
// second term resists bending over distances up to b, which makes tangents continuous at both.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "core/math/vec.h"

namespace cei3d {

struct ArapConstraints {
  std::vector<uint8_t> free;      // #V, 1: moves to minimize the energy
  std::vector<uint32_t> handles;  // vertices that are not free and move to `targets`; all others stay
  std::vector<Vec3f> targets;     // #handles, new positions
};

struct ArapOptions {
  float bending_length = 0;  // b, in units of the positions
  int max_iterations = 60;
  double tolerance = 1e-4;  // stop when an iteration lowers the energy by less than this fraction
};

struct ArapResult {
  std::vector<Vec3f> positions;  // #V; vertices that are neither free nor handles bit-identical
  std::vector<double> energies;  // after each iteration; never increases
};

// Alternates rotations (Procrustes) and positions (one linear system, factorized once). Time depends on the
// number of free vertices. Free vertices that are not connected to a held vertex stay where they are.
// Deterministic.
ArapResult arap_deform(std::span<const Vec3f> positions, std::span<const std::array<uint32_t, 3>> triangles,
                       const ArapConstraints&, const ArapOptions&);

}  // namespace cei3d
