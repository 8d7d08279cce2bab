// SPDX-License-Identifier: Apache-2.0
// Where the pictures are explained worst, so that training looks there more often.
#pragma once

#include <cstddef>
#include <limits>
#include <vector>

#include "core/math/rng.h"

namespace cei3d {

class PixelErrors {
 public:
  explicit PixelErrors(size_t pixels)
      : pixels_(pixels), errors_((pixels + kRun - 1) / kRun, std::numeric_limits<float>::max()) {}

  // Of three random pixels the one in whose run the error was largest when last seen; unseen ones come first.
  size_t choose(Rng& rng) const {
    size_t worst = rng.below(uint32_t(pixels_));
    for (int k = 1; k < kDraws; ++k) {
      const size_t other = rng.below(uint32_t(pixels_));
      if (errors_[other / kRun] > errors_[worst / kRun]) worst = other;
    }
    return worst;
  }
  void saw(size_t pixel, float squared_error) {
    float& e = errors_[pixel / kRun];
    e = e == std::numeric_limits<float>::max() ? squared_error : e + kNews * (squared_error - e);
  }

  const std::vector<float>& runs() const { return errors_; }
  void set_runs(std::vector<float> errors) { errors_ = std::move(errors); }

 private:
  static constexpr size_t kRun = 4;  // neighbours in a row of the picture share an error
  static constexpr float kNews = 0.5f;
  static constexpr int kDraws = 3;
  size_t pixels_;
  std::vector<float> errors_;
};

}  // namespace cei3d
