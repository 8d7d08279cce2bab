// SPDX-License-Identifier: Apache-2.0
#include "engine/photos/photo_segmenter.h"

#include <algorithm>
#include <cmath>

#include "core/base/error.h"
#include "core/image/resample.h"
#include "core/math/quantile.h"
#include "engine/capture/capture_images.h"
#include "engine/io/image_file.h"
#include "engine/segment/saliency.h"
#include "engine/segment/sam.h"

namespace cei3d {
namespace {

class SamSegmenter final : public PhotoSegmenter {
 public:
  SamSegmenter(const std::filesystem::path& folder, int threads)
      : sam_(folder, threads), saliency_(Saliency::find(folder, threads)) {}

  Image log_odds(const View& view, const PixelBox& box, const Prompts& prompts,
                 const std::optional<PixelBox>& around) override {
    constexpr int kEnough = 1024;  // pixels that the network sees
    Image shown = cropped(load_photo(view), box);
    const int n = std::max(1, std::max(box.width, box.height) / kEnough);
    if (n > 1) shown = downscale(shown, n);
    const SamImage encoded = sam_.encode(shown);
    const auto moved = [&](Vec2f p) {
      return Vec2f{(p.x - float(box.x0)) / float(n), (p.y - float(box.y0)) / float(n)};
    };
    const auto all_moved = [&](std::vector<Vec2f> pixels) {
      for (Vec2f& p : pixels) p = moved(p);
      return pixels;
    };
    std::optional<std::array<Vec2f, 2>> corners;
    if (around)
      corners = {{moved({float(around->x0), float(around->y0)}),
                  moved({float(around->x0 + around->width), float(around->y0 + around->height)})}};
    return scaled_to(sam_.mask(encoded, all_moved(prompts.positive), all_moved(prompts.negative), corners),
                     box.width, box.height);
  }

  std::optional<Image> saliency(const View& view) override {
    return saliency_ ? std::optional(saliency_->map(load_photo(view))) : std::nullopt;
  }

 private:
  Sam sam_;
  std::optional<Saliency> saliency_;
};

// Distance between linear colors, relative to how bright they are; shadows and lamps change brightness more
// than hue, so brightness counts half.
float difference(const float* a, const float* b) {
  constexpr float kDark = 0.02f;
  float sum = 0, mean = 0, delta[3];
  for (int c = 0; c < 3; ++c) {
    delta[c] = std::log((std::max(a[c], 0.0f) + kDark) / (std::max(b[c], 0.0f) + kDark));
    mean += delta[c] / 3;
  }
  for (int c = 0; c < 3; ++c) {
    const float d = delta[c] - mean / 2;
    sum += d * d;
  }
  return std::sqrt(sum);
}

class PlateSegmenter final : public PhotoSegmenter {
 public:
  explicit PlateSegmenter(const std::filesystem::path& plate) : plate_(read_linear_image(plate)) {
    if (plate_.channels < 3) fail("{} has no colors.", plate.string());
  }

  Image log_odds(const View& view, const PixelBox& box, const Prompts&,
                 const std::optional<PixelBox>&) override {
    const Image photo = load_photo(view);
    if (photo.width != plate_.width || photo.height != plate_.height)
      fail("{} is {} x {} pixels, but the background plate has {} x {}. Both must be taken from one place.",
           view.image_path.string(), photo.width, photo.height, plate_.width, plate_.height);
    Image apart(photo.width, photo.height, 1);
    std::vector<float> border;
    for (int y = 0; y < photo.height; ++y)
      for (int x = 0; x < photo.width; ++x) {
        *apart.at(x, y) = difference(photo.at(x, y), plate_.at(x, y));
        if (x == 0 || y == 0 || x == photo.width - 1 || y == photo.height - 1)
          border.push_back(*apart.at(x, y));
      }
    // Noise of the background itself, where the photograph shows nothing else.
    constexpr float kNoise = 6, kMin = 0.12f;
    const float threshold = std::max(kMin, kNoise * median(border));
    for (float& d : apart.data) d = 10 * (d / threshold - 1);
    return cropped(apart, box);
  }

 private:
  Image plate_;
};

}  // namespace

Image load_photo(const View& view) {
  View file = view;
  file.camera = view.file_camera();
  file.photo.reset();
  file.mask_path.clear(), file.doubtful_path.clear();
  Image image = load_linear_rgba(file);
  for (size_t i = 3; i < image.data.size(); i += 4) image.data[i] = 1;
  return image;
}

std::unique_ptr<PhotoSegmenter> sam_segmenter(const std::filesystem::path& folder, int threads) {
  return std::make_unique<SamSegmenter>(folder, threads);
}
std::unique_ptr<PhotoSegmenter> plate_segmenter(const std::filesystem::path& plate) {
  return std::make_unique<PlateSegmenter>(plate);
}

}  // namespace cei3d
