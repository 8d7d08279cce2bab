// SPDX-License-Identifier: Apache-2.0
// Frames as image files; `render -h` describes the channels.
#pragma once

#include "engine/render/render.h"
#include "engine/session/requests.h"

namespace cei3d {

// Values as they go into the file, [0, 1]. depth_scale: file value (of 65535) per capture unit.
Image channel_image(const Frame&, Channel, double depth_scale);
int channel_bits(Channel);  // 8 or 16

// The image as an 8-bit file stores it: RGBA, sRGB, rounded.
Image rounded_srgb(const Image& linear_rgba);

// RGBA images of one height, sRGB, on white from left to right.
Image side_by_side(const std::vector<Image>& pictures);

}  // namespace cei3d
