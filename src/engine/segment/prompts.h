// SPDX-License-Identifier: Apache-2.0
// Where to click in a view, given what is believed of the points that it shows. [paper Algorithm 1, which
// leaves open how many prompts there are and which]
#pragma once

#include <span>
#include <vector>

#include "core/math/vec.h"

namespace cei3d {

struct Prompts {
  std::vector<Vec2f> positive, negative;  // continuous pixel positions
};

// Visible points of the surface by what is believed of them: in the part, out of it, or not known (which
// keeps prompts away).
struct BelievedPixels {
  std::vector<Vec2f> in, out, unknown;
};

// Up to `count` of each kind are added to the prompts that there are: far from each other and from where the
// belief changes; negative ones no farther from the part than the part is large.
void add_prompts(const BelievedPixels&, size_t count, Prompts& prompts);

// The pixel of `wrong` that lies deepest among its like: farthest from the pixels that are right. wrong must
// not be empty.
Vec2f deepest(std::span<const Vec2f> wrong, std::span<const Vec2f> right);

}  // namespace cei3d
