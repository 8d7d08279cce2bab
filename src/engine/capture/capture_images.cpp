// SPDX-License-Identifier: Apache-2.0
#include "engine/capture/capture_images.h"

#include <algorithm>
#include <cmath>

#include "core/base/error.h"
#include "core/image/resample.h"
#include "core/math/color.h"
#include "engine/io/image_file.h"

namespace cei3d {
namespace {

void require_path(const View& view) {
  if (view.image_path.empty()) fail("View {} has a camera but no photograph.", view.name);
}

void require_size(const View& view, const Image& image, const std::filesystem::path& path) {
  const Camera& c = view.camera;
  if (image.width != c.width || image.height != c.height)
    fail(
        "{} is {} x {} pixels, but view {} should have {} x {}. All images and masks of a split need one "
        "size.",
        path.string(), image.width, image.height, view.name, c.width, c.height);
}

// Coverage of each pixel by the mask file. Values near black and white, from scaling and compression, count
// as black and white.
std::vector<float> read_mask_file(const View& view) {
  constexpr float kPlain = 0.05f;
  const Image mask = read_image(view.mask_path);
  require_size(view, mask, view.mask_path);
  std::vector<float> coverage(size_t(mask.width) * mask.height);
  for (int y = 0; y < mask.height; ++y)
    for (int x = 0; x < mask.width; ++x)
      coverage[size_t(y) * mask.width + x] =
          std::clamp((luminance(mask.rgb(x, y)) - kPlain) / (1 - 2 * kPlain), 0.0f, 1.0f);
  return coverage;
}

}  // namespace

Image load_linear_rgba(const View& view) {
  require_path(view);
  const Image image = read_linear_image(view.image_path);
  require_size(view, image, view.image_path);
  Image out(image.width, image.height, 4);
  const std::vector<float> mask = view.mask_path.empty() ? std::vector<float>() : read_mask_file(view);
  for (size_t i = 0; i < size_t(image.width) * image.height; ++i) {
    const float* in = &image.data[i * image.channels];
    float* p = &out.data[4 * i];
    for (int c = 0; c < 3; ++c) p[c] = image.channels >= 3 ? in[c] : in[0];
    p[3] = !mask.empty() ? mask[i] : image.channels == 4 ? in[3] : 1.0f;
    if (!std::isfinite(p[0] + p[1] + p[2] + p[3]))
      fail("{} holds NaN or infinite values. Render or convert it again.", view.image_path.string());
  }
  return out;
}

Mask load_mask(const View& view) {
  Mask mask{view.camera.width, view.camera.height, {}, true};
  if (!view.mask_path.empty()) {
    for (const float coverage : read_mask_file(view)) mask.object.push_back(coverage > 0.5f);
    return mask;
  }
  require_path(view);
  const Image image = read_image(view.image_path);
  require_size(view, image, view.image_path);
  mask.stated = image.channels == 4;
  mask.object.assign(size_t(image.width) * image.height, 1);
  if (mask.stated)
    for (size_t i = 0; i < mask.object.size(); ++i) mask.object[i] = image.data[4 * i + 3] > 0.5f;
  return mask;
}

ImageDepth CaptureImages::depth(const View& view) const {
  require_path(view);
  const int bits = read_image_bits(view.image_path);
  return bits == 8 ? ImageDepth::bits8 : bits == 16 ? ImageDepth::bits16 : ImageDepth::open;
}

Image CaptureImages::load(const View& view) const { return downscale(load_linear_rgba(view), downscale_); }

}  // namespace cei3d
