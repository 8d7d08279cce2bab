// SPDX-License-Identifier: Apache-2.0
// Finds a part of the object in one image from a few points: a network, or the truth in tests.
#pragma once

#include <span>

#include "core/image/image.h"
#include "core/math/vec.h"

namespace cei3d {

class ViewSegmenter {
 public:
  virtual ~ViewSegmenter() = default;
  // positive, negative: continuous pixel positions inside and outside the part, at least one positive.
  // Returns log-odds of belonging to the part, 1 channel of the image's size.
  virtual Image mask(int view, std::span<const Vec2f> positive, std::span<const Vec2f> negative) = 0;
};

}  // namespace cei3d
