// SPDX-License-Identifier: Apache-2.0
// Visibility of surface points in a camera.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "core/image/image.h"
#include "core/math/camera.h"
#include "model/geometry/shape/surface.h"

namespace cei3d {

struct SeenPoint {
  uint32_t point;  // index into the positions asked about
  Vec2f pixel;     // continuous position in the image
  float facing;    // cosine between the normal and the direction to the camera
};

// The points, in order, that lie in the image, face the camera by at least min_facing and are not hidden by
// another part of the surface. camera, positions: unit frame. tolerance: distance behind the surface up to
// which a point counts as on it.
std::vector<SeenPoint> seen_points(const Surface&, const Camera& camera, std::span<const Vec3f> positions,
                                   std::span<const Vec3f> normals, float min_facing, float tolerance);

// Bilinear between pixel centers of a one-channel image, clamped at the border.
float sample(const Image& image, Vec2f pixel);

}  // namespace cei3d
