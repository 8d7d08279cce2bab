// SPDX-License-Identifier: Apache-2.0
// The base color that the object shows, edits included: at its handler points, and as a picture. What parts
// are told apart by: no light, shadow or highlight disturbs there.
#pragma once

#include <vector>

#include "core/image/image.h"
#include "engine/render/render.h"

namespace cei3d {

// The handler points of the scene as hits, on the triangle of the present surface that each lies on; so they
// are known in every pose.
std::vector<Hit> handler_hits(const Scene&);

// #handlers of the scene, linear.
std::vector<Vec3f> handler_colors(const Device&, const Scene&);

// RGBA, linear, straight alpha, of the camera's size. camera: unit-sphere frame.
Image base_color_picture(const Device&, const Scene&, const Camera& camera);

}  // namespace cei3d
