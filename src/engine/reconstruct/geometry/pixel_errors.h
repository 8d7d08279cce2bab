// SPDX-License-Identifier: Apache-2.0
// The errors of pixels when last rendered, so that training draws those with large errors more often.
#pragma once

#include <cstddef>
#include <limits>
#include <vector>

#include "core/math/rng.h"

namespace cei3d {

struct PixelError {
  size_t pixel;
  float squared_error;  // display-encoded, summed over channels
};

// Blocks of neighboring pixels in a row of an image share an error.
class PixelErrors {
 public:
  explicit PixelErrors(size_t pixels)
      : pixels_(pixels), errors_((pixels + kBlock - 1) / kBlock, std::numeric_limits<float>::max()) {}

  // The one of three random pixels whose block has the largest error; blocks not rendered yet come first.
  size_t choose(Rng& rng) const {
    size_t worst = rng.below(uint32_t(pixels_));
    for (int k = 1; k < kDraws; ++k) {
      const size_t other = rng.below(uint32_t(pixels_));
      if (errors_[other / kBlock] > errors_[worst / kBlock]) worst = other;
    }
    return worst;
  }
  void record(const PixelError& p) {
    float& e = errors_[p.pixel / kBlock];
    e = e == std::numeric_limits<float>::max() ? p.squared_error : e + kBlend * (p.squared_error - e);
  }

  const std::vector<float>& block_errors() const { return errors_; }
  void set_block_errors(std::vector<float> errors) { errors_ = std::move(errors); }

 private:
  static constexpr size_t kBlock = 4;    // pixels
  static constexpr float kBlend = 0.5f;  // share of the newest error in a running mean
  static constexpr int kDraws = 3;
  size_t pixels_;
  std::vector<float> errors_;
};

}  // namespace cei3d
