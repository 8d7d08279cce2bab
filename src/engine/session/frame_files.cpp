// SPDX-License-Identifier: Apache-2.0
#include "engine/session/frame_files.h"

#include <algorithm>
#include <cmath>

#include "core/math/color.h"
#include "engine/io/image_file.h"
#include "engine/metrics/psnr.h"

namespace cei3d {
namespace {

// Straight alpha; 0 where nothing was hit.
Image color_picture(const Image& linear) {
  Image out = srgb_from_linear(linear);
  for (size_t i = 0; i < out.data.size(); i += 4)
    if (out.data[i + 3] <= 0) out.data[i] = out.data[i + 1] = out.data[i + 2] = 0;
  return out;
}

// Where nothing was hit the value is mid gray, which decodes to the zero vector.
Image normal_picture(const Image& normals) {
  Image out(normals.width, normals.height, 3);
  for (size_t i = 0; i < out.data.size(); i += 3) {
    for (size_t c = 0; c < 3; ++c) out.data[i + c] = 0.5f * (normals.data[i + c] + 1);
  }
  return out;
}

Image scaled(Image image, float factor) {
  for (float& v : image.data) v *= factor;
  return image;
}

}  // namespace

Image channel_image(const Frame& f, Channel channel, double depth_scale) {
  switch (channel) {
    case Channel::rgb:
      return color_picture(f.rgb);
    case Channel::albedo:
      return color_picture(f.albedo);
    case Channel::diffuse:
      return color_picture(f.diffuse);
    case Channel::specular:
      return color_picture(f.specular);
    case Channel::normal:
      return normal_picture(f.normal);
    case Channel::depth:
      return scaled(f.depth, float(depth_scale / 65535));
    case Channel::roughness:
      return f.roughness;
    case Channel::metalness:
      return f.metalness;
    case Channel::mask:
      return f.mask;
  }
  return {};
}

int channel_bits(Channel c) { return c == Channel::normal || c == Channel::depth ? 16 : 8; }

Image rounded_srgb(const Image& linear_rgba) {
  Image out = color_picture(linear_rgba);
  for (float& v : out.data) v = std::round(clamp(v, 0.0f, 1.0f) * 255) / 255;
  return out;
}

Image side_by_side(const std::vector<Image>& pictures) {
  int width = 0;
  for (const Image& p : pictures) width += p.width;
  Image out(width, pictures.empty() ? 0 : pictures[0].height, 3);
  int left = 0;
  for (const Image& p : pictures) {
    const Image on_white = over_background(p, 1);
    for (int y = 0; y < out.height; ++y) std::copy_n(on_white.at(0, y), 3 * on_white.width, out.at(left, y));
    left += p.width;
  }
  return out;
}

}  // namespace cei3d
