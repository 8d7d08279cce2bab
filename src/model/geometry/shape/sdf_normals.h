// SPDX-License-Identifier: Apache-2.0
// Normals of a signed distance field, smooth where the surface is and sharp at its edges.
#pragma once

#include <span>
#include <vector>

#include "core/math/vec.h"
#include "model/field/field.h"

namespace cei3d {

// Steps of the central differences that normals are taken from, unit-sphere units. Wide ones even out a
// trilinear grid, whose own gradient jumps at every cell face (docs/method.md#surface); narrow ones do
// not round off edges. Equal without a grid.
struct NormalSteps {
  float wide, narrow;
};
NormalSteps normal_steps(const FieldConfig&);

// Unit normals of the field at points x: the wide ones, but where they and the narrow ones point to different
// sides, which only an edge makes them, these. x, out: #N. edges: empty, or #N: the share that the narrow
// ones have, [0, 1].
void sdf_normals(const Device&, const Field& sdf, std::span<const Vec3f> x, std::span<Vec3f> out,
                 std::span<float> edges = {});

// The adjoint: appends the points at which a loss with slopes d_normals (tangent to the surface) wants other
// values of the field, and its slopes by them. Takes the length of the field's gradient for one, and `edges`,
// #N, as given.
void add_value_slopes(const FieldConfig&, std::span<const Vec3f> x, std::span<const Vec3f> d_normals,
                      std::span<const float> edges, std::vector<Vec3f>& points, std::vector<float>& d_values);

}  // namespace cei3d
