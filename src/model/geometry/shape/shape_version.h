// SPDX-License-Identifier: Apache-2.0
// Shape versions of the object. Version 0 is the reconstructed surface, version k the surface after k changes
// of shape. Vertex ids keep their meaning, so the place of a hit on the last version is known in all earlier
// ones: texture, parts and paint follow the object.
#pragma once

#include <memory>
#include <vector>

#include "model/field/field.h"
#include "model/geometry/shape/reshape.h"
#include "model/geometry/shape/surface.h"

namespace cei3d {

struct ShapeVersion {
  std::shared_ptr<const Surface> surface;
  // The members below are empty in version 0.
  std::vector<Mat3f> gradients;  // #V, deformation gradient since version 0, or since the vertex was made
  std::vector<int> born;         // #F, version that added the triangle; 0: reconstructed
  std::vector<int> shaped;       // #F, version that gave the triangle its present shape
  // #F, id of the triangle in the version before; 0 for a triangle that this version added.
  std::vector<uint32_t> before;
  std::vector<Vec3f> colors;  // #V, linear albedo of added surface; unused elsewhere
  // Distance field of the surface that this version gave its shape; null: that of version 0, in which points
  // of that surface are looked up.
  std::shared_ptr<const Field> sdf;

  int born_in(uint32_t triangle) const { return born.empty() ? 0 : born[triangle]; }
  int shaped_in(uint32_t triangle) const { return shaped.empty() ? 0 : shaped[triangle]; }
};

// Version 0 to the present one; empty: the shape was never changed.
using ShapeVersions = std::vector<std::shared_ptr<const ShapeVersion>>;

// Appends the version after a change of `surface`, the present one. Visibility is recomputed for vertices
// that moved or are new; the others keep theirs, so that unchanged surface renders as before. sdf: of the
// changed surface; may be null. Error: the change does not fit the surface.
ShapeVersions with_version(ShapeVersions versions, std::shared_ptr<const Surface> surface,
                           const Reshape& change, std::shared_ptr<const Field> sdf = nullptr);

struct SurfacePoint {
  Vec3f position, normal;  // unit frame; unit
};
// Position and normal in version k of a hit on the present surface; k must not be earlier than the hit's
// triangle. A hit on a triangle that has not changed since version k is returned bit for bit.
SurfacePoint in_version(const ShapeVersions&, const Hit&, int k);

// Deformation gradient since version 0, and mesh position, at the hit's barycentric coordinates in the given
// version.
Mat3f gradient_at(const ShapeVersion&, const std::array<uint32_t, 3>& corners, const Hit&);
Vec3f mesh_point(const ShapeVersion&, const std::array<uint32_t, 3>& corners, const Hit&);

}  // namespace cei3d
