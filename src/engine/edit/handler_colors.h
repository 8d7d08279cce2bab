// SPDX-License-Identifier: Apache-2.0
// The base colour that the object shows, edits included: at its handler points, and as a picture. What parts
// are told apart by: no light, shadow or highlight disturbs there.
#pragma once

#include <vector>

#include "core/image/image.h"
#include "engine/render/render.h"

namespace cei3d {

// #handlers of the scene, linear; black for one that lies off the present surface.
std::vector<Vec3f> handler_colors(const Device&, const Scene&);

// RGBA, linear, straight alpha, of the camera's size. camera: unit-sphere frame.
Image base_color_picture(const Device&, const Scene&, const Camera& camera);

}  // namespace cei3d
