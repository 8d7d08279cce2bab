// SPDX-License-Identifier: Apache-2.0
#include "engine/photos/still_pixels.h"

#include <algorithm>
#include <cmath>

#include "core/base/cancel.h"
#include "core/base/error.h"
#include "core/image/resample.h"
#include "core/math/color.h"
#include "engine/io/image_file.h"

namespace cei3d {
namespace {

constexpr int kSize = 400;          // pixels of the longer side that are compared
constexpr float kSame = 0.03f;      // sRGB luminance
constexpr double kNearlyAll = 0.8;  // share of photographs that must agree with the middle one

std::vector<float> small_luminance(const std::filesystem::path& photo, StillPixels& size) {
  const Image image = read_linear_image(photo);
  if (size.width == 0) {
    size.width = image.width, size.height = image.height;
    size.reduction = std::max(1, std::max(image.width, image.height) / kSize);
  }
  if (image.width != size.width || image.height != size.height)
    fail("{} has another size than the first photograph; on a turntable the camera stands still.",
         photo.string());
  const Image small = downscale(image, size.reduction);
  std::vector<float> out;
  for (int y = 0; y < small.height; ++y)
    for (int x = 0; x < small.width; ++x)
      out.push_back(srgb_from_linear(std::clamp(luminance(small.rgb(x, y)), 0.0f, 1.0f)));
  return out;
}

}  // namespace

StillPixels still_pixels(const std::vector<std::filesystem::path>& photos, const Progress& progress) {
  StillPixels out;
  std::vector<std::vector<float>> all;
  for (const auto& p : photos) {
    check_cancelled(progress);
    all.push_back(small_luminance(p, out));
  }
  if (all.empty()) return out;
  std::vector<float> values(all.size());
  for (size_t i = 0; i < all[0].size(); ++i) {
    for (size_t v = 0; v < all.size(); ++v) values[v] = all[v][i];
    std::sort(values.begin(), values.end());
    const float middle = values[values.size() / 2];
    const auto same =
        std::count_if(values.begin(), values.end(), [&](float v) { return std::abs(v - middle) < kSame; });
    out.area.push_back(double(same) > kNearlyAll * double(values.size()));
  }
  return out;
}

}  // namespace cei3d
