// SPDX-License-Identifier: Apache-2.0
// The training pixels of the object and a rim around it, packed into 10 bytes each, so that 100 views of 800
// x 800 fit in memory; 16 bytes where a file holds more than 8 bits a channel.
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <vector>

#include "core/image/image.h"
#include "core/math/camera.h"
#include "model/scene/view.h"

namespace cei3d {

// Display-encoded color over white, and coverage.
struct Target {
  Vec3f srgb;
  float alpha;
};

struct Pixel {
  uint16_t view, x, y;
  std::array<uint8_t, 4> srgba;  // display-encoded color, at most 1; straight alpha
};

class PixelStore {
 public:
  // image: RGBA, linear, straight alpha, below 0 where unknown. Keeps known pixels with an alpha above zero
  // within `rim` pixels. depth: of the file. Files of 8 bits are kept as display-encoded bytes alone, others
  // with their radiance, too.
  void add_view(const Camera& unit_camera, const Image& image, int rim, ImageDepth depth = ImageDepth::bits8);

  const std::vector<Camera>& cameras() const { return cameras_; }
  void set_cameras(std::vector<Camera> cameras) { cameras_ = std::move(cameras); }  // one a view, of its size
  const std::vector<Pixel>& pixels() const { return pixels_; }
  // Factors by which the linear channels of each view are brighter than they should be; empty: none is.
  // Colors are divided by them. A color that becomes brighter than white is white in target().
  void set_exposures(std::vector<Vec3f> factors);
  const std::vector<Vec3f>& exposures() const { return exposures_; }
  Vec3f radiance(size_t pixel) const;  // linear, as far as the file holds it
  Target target(const Pixel&) const;
  // Bit c: channel c is at the upper limit of its file, its radiance may be higher.
  uint8_t clipped(size_t pixel) const;
  // The mask of each view, row-major: kObject where alpha > 0.5, kUnknown where alpha < 0 (visual_hull.h).
  const std::vector<std::vector<uint8_t>>& masks() const { return masks_; }
  // Ray through the center of a pixel plus `away` (pixels), unit frame.
  Ray ray(const Pixel& p, Vec2f away = {0, 0}) const {
    return cameras_[p.view].ray(float(p.x) + 0.5f + away.x, float(p.y) + 0.5f + away.y);
  }

 private:
  std::vector<Camera> cameras_;
  std::vector<Pixel> pixels_;
  // Radiance as half floats: #pixels, or empty when all files have 8 bits.
  std::vector<std::array<uint16_t, 3>> halves_;
  std::vector<ImageDepth> depths_;  // of the views
  std::vector<std::vector<uint8_t>> masks_;
  std::vector<Vec3f> exposures_;
  // Display-encoded colors of the bytes, by view and channel; empty without exposures.
  std::vector<std::array<std::array<float, 256>, 3>> curves_;
};

}  // namespace cei3d
