// SPDX-License-Identifier: Apache-2.0
// Which points of a surface a camera sees, and where in its picture.
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
  Vec2f pixel;     // continuous position in the picture
  float facing;    // cosine between the normal and the way to the camera
};

// Those that lie in the picture, face the camera by at least min_facing and that no other part of the surface
// hides, in order. camera, positions: unit-sphere frame. tolerance: how far behind the surface a point still
// counts as on it.
std::vector<SeenPoint> seen_points(const Surface&, const Camera& camera, std::span<const Vec3f> positions,
                                   std::span<const Vec3f> normals, float min_facing, float tolerance);

// Bilinear between the centers of the pixels of a one-channel picture, the border's value beyond it.
float sample(const Image& image, Vec2f pixel);

}  // namespace cei3d
