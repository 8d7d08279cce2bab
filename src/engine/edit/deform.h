// SPDX-License-Identifier: Apache-2.0
// `edit deform`: drags points of the surface; the surface around them, or a part, follows as rigidly as
// possible. [paper sec. 4.3; docs/method.md#changes-of-shape]
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "core/base/progress.h"
#include "core/base/settings.h"
#include "core/compute/device.h"
#include "engine/edit/refit_field.h"
#include "model/scene/scene.h"

namespace cei3d {

struct DeformHandle {
  Vec3f from, to;  // unit frame; from: on or near the surface
  // Rotation of the surface around the handle, about `from`: axis times angle in radians.
  Vec3f turn{0, 0, 0};
};

enum class DeformedGeometry {
  mesh,   // hits are looked up in the undeformed field through the deformation of the mesh
  field,  // the moved surface gets a field of its own [paper eq. 18]
};

struct DeformOptions {
  // Share of the radius that moves rigidly with the handle, and over which bending is resisted. Dragging a
  // single vertex makes a spike; with about a sixth, most of the radius remains for the fall-off. (On the ear
  // of spot shares of 0, 0.15, 0.25 differ from an artist's smooth fall-off by 0.10, 0.06, 0.09 of the drag.)
  float handle_share = 0.15f;
  int iterations = 0;    // of the deformation of the mesh; 0: as many as a few seconds allow
  RefitOptions refit{};  // of the field
};
const SettingTable<DeformOptions>& deform_settings();

struct DeformRequest {
  std::string id;                     // of the new layer
  std::vector<DeformHandle> handles;  // at least one
  std::optional<float> radius;        // distance along the surface from a handle within which vertices move
  std::string part;                   // only this part moves; empty: the whole object
  std::vector<Vec3f> pins{};          // points of the surface around which nothing moves, unit frame
  DeformedGeometry geometry = DeformedGeometry::mesh;
  DeformOptions options{};
};

struct DeformReport {
  size_t vertices = 0;  // number of moved vertices
  float farthest = 0;   // largest movement, unit frame
  float radius = 0;     // distance along the surface within which vertices moved, unit frame
  int iterations = 0;
  // With a field of its own: mean distance of its surface from the deformed mesh, unit frame.
  std::optional<float> misfit;
  double seconds = 0;
};

struct DeformResult {
  EditLayer layer;
  DeformReport report;
};

// Default radius: 0.3 in the unit frame, or one and a half times the longest drag if that is more.
//
// The deformation itself is solved on the mesh instead of on handler points: the radius contains some
// thousand vertices, which are solved for exactly in a fraction of a second, and no interpolation between
// handler points shows in highlights. Handler points move with the mesh.
//
// Pure: the scene is not changed. Errors: no surface near a handle or pin, a handle that is not on the part,
// a drag of no length or out of the unit sphere, nothing or everything within the radius, no such part, a
// field that does not take the new shape, cancelled.
DeformResult deform(const Device&, const Scene&, const DeformRequest&, Progress&);

}  // namespace cei3d
