// SPDX-License-Identifier: Apache-2.0
// `edit deform`: drags a point of the surface; the surface around it, or its part, follows as rigidly as
// possible. [paper sec. 4.3; docs/method.md#changes-of-shape]
#pragma once

#include <optional>
#include <string>

#include "core/base/progress.h"
#include "core/compute/device.h"
#include "model/scene/scene.h"

namespace cei3d {

struct DeformRequest {
  std::string id;               // of the new layer
  Vec3f from, to;               // unit frame; from: on or near the surface
  std::optional<float> radius;  // distance along the surface within which vertices move, unit frame
  std::string part;             // only this part moves; empty: the whole object
};

struct DeformReport {
  size_t vertices = 0;  // number of moved vertices
  float farthest = 0;   // largest movement, unit frame
  float radius = 0;     // distance along the surface within which vertices moved, unit frame
  int iterations = 0;
  double seconds = 0;
};

struct DeformResult {
  EditLayer layer;
  DeformReport report;
};

// Default radius: 0.3 of the unit sphere's, or one and a half times the drag if that is more.
//
// Works on the mesh instead of on handler points: the radius contains some thousand vertices, which are
// solved for exactly in a fraction of a second, and no interpolation between handler points shows in
// highlights. Handler points move with the mesh.
//
// Pure: the scene is not changed. Errors: no surface near the handle, a handle that is not on the part, a
// drag of no length or out of the unit sphere, nothing or everything within the radius, no such part,
// cancelled.
DeformResult deform(const Scene&, const DeformRequest&, Progress&);

}  // namespace cei3d
