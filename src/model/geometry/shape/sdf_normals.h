// SPDX-License-Identifier: Apache-2.0
// Normals of a signed distance field, smooth where the surface is and sharp at its edges.
#pragma once

#include <span>
#include <vector>

#include "core/math/vec.h"
#include "model/field/field.h"

namespace cei3d {

// Steps of the central differences that normals are computed by, unit frame. Wide differences smooth a
// trilinear grid, whose gradient jumps at every cell face; narrow ones do not round off edges
// (docs/method.md#surface). Both are equal for fields without a grid.
struct NormalSteps {
  float wide, narrow;
};
NormalSteps normal_steps(const FieldConfig&);

// Unit normals of the field at points x: by wide differences, or by narrow ones where the two disagree, which
// happens only at edges. x, out: #N. edges: empty, or #N: weight of the narrow differences, [0, 1].
void sdf_normals(const Device&, const Field& sdf, std::span<const Vec3f> x, std::span<Vec3f> out,
                 std::span<float> edges = {});

// The gradients whose directions sdf_normals() gives. x: #N. edges: as there.
std::vector<Vec3f> sdf_gradients(const Device&, const Field& sdf, std::span<const Vec3f> x,
                                 std::span<float> edges = {});
// Derivatives of sdf_gradients() along unit directions (#N): Hessian times direction, by central differences.
// edges: #N, of sdf_gradients(), held constant.
std::vector<Vec3f> sdf_gradients_along(const Device&, const Field& sdf, std::span<const Vec3f> x,
                                       std::span<const Vec3f> directions, std::span<const float> edges);

// Adjoint of sdf_gradients(): appends the points whose field values enter the gradients, and dL/d(those
// values), from d_gradients. Takes `edges`, #N, as constant. For gradients of length one and d_gradients
// tangent to the surface it is the adjoint of sdf_normals(), too.
void add_value_grads(const FieldConfig&, std::span<const Vec3f> x, std::span<const Vec3f> d_gradients,
                     std::span<const float> edges, std::vector<Vec3f>& points, std::vector<float>& d_values);

}  // namespace cei3d
