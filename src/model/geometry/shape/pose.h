// SPDX-License-Identifier: Apache-2.0
// The shapes that the object has had. Pose 0 is the reconstructed surface, pose k what k changes of geometry
// made of it. Vertex ids mean the same in all poses, so a point that was hit in the last one is known in all
// earlier ones: texture, parts and paint follow the matter.
#pragma once

#include <memory>
#include <vector>

#include "model/geometry/shape/reshape.h"
#include "model/geometry/shape/surface.h"

namespace cei3d {

struct Pose {
  std::shared_ptr<const Surface> surface;
  // The rest is empty in pose 0.
  std::vector<Mat3f> gradients;  // #V, of the deformation since pose 0, or since the vertex was made
  std::vector<int> born;         // #F, the pose that the triangle was made in; 0: reconstructed
  std::vector<int> shaped;       // #F, the pose that gave the triangle its present shape; 0: as reconstructed
  // #F, the same triangle in the pose before; for one that was made in this pose: 0
  std::vector<uint32_t> before;
  std::vector<Vec3f> colors;  // #V, linear base color that new matter has there; unused elsewhere

  int born_in(uint32_t triangle) const { return born.empty() ? 0 : born[triangle]; }
  int shaped_in(uint32_t triangle) const { return shaped.empty() ? 0 : shaped[triangle]; }
};

// Pose 0 to the present one; empty: there has been no change.
using Poses = std::vector<std::shared_ptr<const Pose>>;

// Adds the pose after a change of `surface`, the present one. Vertices that moved or are new look at the sky
// anew; the others keep what they saw, so that what did not change looks as before. Error: the change does
// not fit the surface.
Poses with_pose(Poses poses, std::shared_ptr<const Surface> surface, const Reshape& change);

struct SurfacePoint {
  Vec3f position, normal;  // unit-sphere frame; unit
};
// Where a hit on the present surface was in pose k, which must not be earlier than its triangle. A hit on a
// triangle that has not changed since keeps its bits.
SurfacePoint in_pose(const Poses&, const Hit&, int k);

// The deformation since pose 0, and the point of the mesh, at a hit's place of these corners in some pose.
Mat3f gradient_at(const Pose&, const std::array<uint32_t, 3>& corners, const Hit&);
Vec3f mesh_point(const Pose&, const std::array<uint32_t, 3>& corners, const Hit&);

}  // namespace cei3d
