// SPDX-License-Identifier: Apache-2.0
// Something that finds an object's part in one picture from a few points: a network, or in tests the truth.
#pragma once

#include <span>

#include "core/image/image.h"
#include "core/math/vec.h"

namespace cei3d {

class ViewSegmenter {
 public:
  virtual ~ViewSegmenter() = default;
  // positive, negative: continuous pixel positions in and out of the part, at least one of the former.
  // Returns one channel of the picture's size: log-odds of belonging to the part, above 0 where it rather
  // does.
  virtual Image mask(int view, std::span<const Vec2f> positive, std::span<const Vec2f> negative) = 0;
};

}  // namespace cei3d
