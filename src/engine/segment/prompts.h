// SPDX-License-Identifier: Apache-2.0
// Chooses prompts for a segmentation network in a view, from the belief about the points that the view shows.
// [paper Algorithm 1, which leaves the number and choice of prompts open]
#pragma once

#include <span>
#include <vector>

#include "core/math/vec.h"

namespace cei3d {

struct Prompts {
  std::vector<Vec2f> positive, negative;  // continuous pixel positions
};

// Visible points of the surface by belief: in the part, outside, or unknown. No prompts are placed near
// unknown ones.
struct BelievedPixels {
  std::vector<Vec2f> in, out, unknown;
};

// Adds up to `count` prompts of each kind: far from each other and from where the belief changes; negative
// ones no farther from the part than its size.
void add_prompts(const BelievedPixels&, size_t count, Prompts& prompts);

// At most `count` of the pixels, far from each other: first the one nearest to their mean, then each time the
// one farthest from those chosen.
std::vector<Vec2f> spread(std::span<const Vec2f> pixels, size_t count);

// The pixel of `wrong` that is farthest from the pixels that are right. wrong must not be empty.
Vec2f deepest(std::span<const Vec2f> wrong, std::span<const Vec2f> right);

}  // namespace cei3d
