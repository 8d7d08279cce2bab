// SPDX-License-Identifier: Apache-2.0
// Albedo of the edited object at its handler points and as an image. Parts are selected by it, because it has
// no shadows or highlights.
#pragma once

#include <vector>

#include "core/image/image.h"
#include "engine/render/render.h"

namespace cei3d {

// #handlers, linear albedo.
std::vector<Vec3f> handler_colors(const Device&, const Scene&);

// Albedo image: RGBA, linear, straight alpha, of the camera's size. camera: unit frame.
Image albedo_image(const Device&, const Scene&, const Camera& camera);

}  // namespace cei3d
