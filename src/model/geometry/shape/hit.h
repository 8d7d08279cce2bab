// SPDX-License-Identifier: Apache-2.0
// Where rays meet the surface: what tracing returns, and shading and edits work on.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "core/math/mirror.h"

namespace cei3d {

// A point where a camera ray meets the surface. Unit frame.
struct Hit {
  Vec3f position;
  Vec3f normal;       // unit, outward; sdf_normals()
  Vec3f to_camera;    // unit, from the hit to the camera
  uint32_t triangle;  // of the surface mesh, nearest along the ray
  float b1, b2;       // barycentric coordinates: p = (1 - b1 - b2) v0 + b1 v1 + b2 v2
};

// Rays from a point of the surface start this far above it (unit frame), so that they do not meet the
// triangle that they leave.
inline constexpr float kRayLift = 2e-3f;

inline Vec3f ray_origin(const Hit& h) { return h.position + h.normal * kRayLift; }

// Unit direction from which a mirror at the hit would reflect light to the camera.
inline Vec3f mirror_direction(const Hit& h) { return mirrored_direction(h.normal, h.to_camera); }

// The hit with its directions rotated and its position as it is.
inline Hit with_rotated_directions(Hit h, const Mat3f& rotation) {
  h.normal = rotation * h.normal;
  h.to_camera = rotation * h.to_camera;
  return h;
}

inline std::vector<Vec3f> positions_of(std::span<const Hit> hits) {
  std::vector<Vec3f> out;
  out.reserve(hits.size());
  for (const Hit& h : hits) out.push_back(h.position);
  return out;
}

}  // namespace cei3d
