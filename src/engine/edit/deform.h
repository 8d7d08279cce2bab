// SPDX-License-Identifier: Apache-2.0
// `edit deform`: a point of the surface is dragged, and the surface around it, or the part it is on, follows
// as rigidly as it can. [paper sec. 4.3]
#pragma once

#include <optional>
#include <string>

#include "core/base/progress.h"
#include "core/compute/device.h"
#include "model/scene/scene.h"

namespace cei3d {

struct DeformRequest {
  std::string id;               // of the new layer
  Vec3f from, to;               // unit-sphere frame; from: on or near the surface
  std::optional<float> radius;  // along the surface from the handle, unit-sphere units: what is farther stays
  std::string part;             // what is not on it stays; empty: the whole object
};

struct DeformReport {
  size_t vertices = 0;  // that moved
  float farthest = 0;   // move, unit-sphere units
  float radius = 0;     // of what moved, along the surface from the handle, unit-sphere units
  int iterations = 0;
  double seconds = 0;
};

struct DeformResult {
  EditLayer layer;
  DeformReport report;
};

// Without radius and part, the radius is 0.3 of the unit sphere's, or one and a half times the drag if that
// is more.
//
// On the surface's mesh rather than on the handler points: a radius takes in some thousand vertices, which
// are solved for exactly in a fraction of a second, and nothing has to be interpolated between handlers,
// where highlights would show their spacing. Handler points are carried by the mesh.
//
// Pure: the scene is not changed. Errors: no surface near the handle, a handle that is not on the part, a
// drag of no length or out of the unit sphere, nothing or everything within the radius, no such part,
// cancelled.
DeformResult deform(const Scene&, const DeformRequest&, Progress&);

}  // namespace cei3d
