// SPDX-License-Identifier: Apache-2.0
#include "engine/capture/capture_images.h"

#include <algorithm>
#include <cmath>

#include "core/base/error.h"
#include "core/image/resample.h"
#include "core/math/color.h"
#include "engine/capture/undistort.h"
#include "engine/io/image_file.h"

namespace cei3d {
namespace {

void require_path(const View& view) {
  if (view.image_path.empty()) fail("View {} has a camera but no photograph.", view.name);
}

// Turns an image whose sides are swapped against the camera's, if its EXIF orientation says so.
Image of_camera_size(const View& view, Image image) {
  const Camera& c = view.file_camera();
  if (image.width == c.height && image.height == c.width && image.width != c.width)
    image = turned(std::move(image), read_image_exif(view.image_path).orientation);
  if (image.width != c.width || image.height != c.height)
    fail(
        "{} is {} x {} pixels, but view {} should have {} x {}. Do its image and its camera belong together?",
        view.image_path.string(), image.width, image.height, view.name, c.width, c.height);
  return image;
}

// Values near black and white, from scaling and compression, count as black and white.
Image coverage_of(const Image& mask, bool dark_object) {
  constexpr float kPlain = 0.05f;
  Image coverage(mask.width, mask.height, 1);
  for (int y = 0; y < mask.height; ++y)
    for (int x = 0; x < mask.width; ++x) {
      const float bright = std::clamp((luminance(mask.rgb(x, y)) - kPlain) / (1 - 2 * kPlain), 0.0f, 1.0f);
      *coverage.at(x, y) = dark_object ? 1 - bright : bright;
    }
  return coverage;
}

// Coverage of each pixel by the mask file.
Image read_mask_file(const View& view) {
  const Camera& c = view.file_camera();
  const Image mask = read_image(view.mask_path);
  Image coverage = coverage_of(mask, view.dark_object);
  if (mask.width == c.width && mask.height == c.height) return coverage;
  if (!same_proportions({mask.width, mask.height}, {c.width, c.height}))
    fail("{} is {} x {} pixels and does not fit view {}, which has {} x {}. Is it the mask of another image?",
         view.mask_path.string(), mask.width, mask.height, view.name, c.width, c.height);
  return scaled_to(coverage, c.width, c.height);
}

// The mask in the photograph's size, before any lens is undone. Colors need not be decoded to linear for a
// mask.
Image file_coverage(const View& view, bool& stated) {
  stated = true;
  if (!view.mask_path.empty()) return read_mask_file(view);
  require_path(view);
  const Image image = of_camera_size(view, read_image(view.image_path));
  stated = image.channels == 4;
  Image coverage(image.width, image.height, 1, 1.0f);
  for (size_t i = 0; stated && i < coverage.data.size(); ++i)
    coverage.data[i] = view.dark_object ? 1 - image.data[4 * i + 3] : image.data[4 * i + 3];
  return coverage;
}

Mask mask_of(const Image& coverage, bool stated) {
  Mask mask{coverage.width, coverage.height, {}, stated};
  mask.object.reserve(coverage.data.size());
  for (const float v : coverage.data)
    mask.object.push_back(v == kUnknownAlpha ? kUnknown : v > 0.5f ? kObject : kBackground);
  return mask;
}

Image file_rgba(const View& view) {
  require_path(view);
  const Image image = of_camera_size(view, read_linear_image(view.image_path));
  Image out(image.width, image.height, 4);
  const Image mask = view.mask_path.empty() ? Image() : read_mask_file(view);
  for (size_t i = 0; i < size_t(image.width) * image.height; ++i) {
    const float* in = &image.data[i * image.channels];
    float* p = &out.data[4 * i];
    for (int c = 0; c < 3; ++c) p[c] = image.channels >= 3 ? in[c] : in[0];
    p[3] = !mask.empty() ? mask.data[i] : image.channels < 4 ? 1.0f : view.dark_object ? 1 - in[3] : in[3];
    if (!std::isfinite(p[0] + p[1] + p[2] + p[3]))
      fail("{} holds NaN or infinite values. Render or convert it again.", view.image_path.string());
  }
  return out;
}

// The last channel gets kUnknownAlpha where the mask is overruled.
void forget_doubtful(const View& view, Image& image) {
  if (view.doubtful_path.empty()) return;
  const Image doubtful = read_image(view.doubtful_path);
  if (doubtful.width != image.width || doubtful.height != image.height || doubtful.channels != 1)
    fail("{} does not fit view {}; reconstruct the object again.", view.doubtful_path.string(), view.name);
  for (size_t i = 0; i < doubtful.data.size(); ++i)
    if (doubtful.data[i] > 0.5f) image.data[(i + 1) * size_t(image.channels) - 1] = kUnknownAlpha;
}

}  // namespace

Image load_linear_rgba(const View& view) {
  Image image = file_rgba(view);
  if (view.photo) image = undistorted(image, *view.photo, view.camera);
  forget_doubtful(view, image);
  return image;
}

Mask load_mask(const View& view) {
  bool stated = true;
  Image coverage = file_coverage(view, stated);
  if (view.photo) coverage = undistorted(coverage, *view.photo, view.camera);
  forget_doubtful(view, coverage);
  return mask_of(coverage, stated);
}

Mask load_file_mask(const View& view) {
  bool stated = true;
  const Image coverage = file_coverage(view, stated);
  return mask_of(coverage, stated);
}

ImageDepth CaptureImages::depth(const View& view) const {
  require_path(view);
  const int bits = read_image_bits(view.image_path);
  return bits == 8 ? ImageDepth::bits8 : bits == 16 ? ImageDepth::bits16 : ImageDepth::open;
}

std::optional<double> CaptureImages::exposure(const View& view) const {
  require_path(view);
  return read_image_exif(view.image_path).exposure;
}

Image CaptureImages::load(const View& view) const { return downscale(load_linear_rgba(view), downscale_); }

}  // namespace cei3d
