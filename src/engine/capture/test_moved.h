// SPDX-License-Identifier: Apache-2.0
// Masks of a ball with a knob, which was moved between two views.
#pragma once

#include "engine/capture/mask_votes.h"
#include "engine/capture/test_balls.h"
#include "engine/synthetic/views.h"

namespace cei3d {

inline constexpr Ball kBody{{0, 0, 0}, 0.5}, kKnob{{0.5, 0, 0.2}, 0.2}, kMovedKnob{{0.45, 0.25, 0.25}, 0.2};

// Views from all sides, as of an object that was turned before each photograph, of which the first `before`
// show the knob in its first place. size: of both sides, in pixels.
inline SmallMasks moved_masks(int before, int after, int size, Ball moved = kMovedKnob) {
  SmallMasks out;
  for (const bool later : {false, true})
    for (const Camera& c : spread_cameras(later ? after : before, lens_of_size(size, size))) {
      const Ball balls[] = {kBody, later ? moved : kKnob};
      out.cameras.push_back(c);
      out.masks.push_back(seen_balls(balls, c));  // kBackground is 0, kObject 1
    }
  return out;
}

// Where the outlines of the two differ.
inline Area changed_pixels(const Camera& camera) {
  const Ball before[] = {kBody, kKnob}, after[] = {kBody, kMovedKnob};
  const Area was = seen_balls(before, camera), is = seen_balls(after, camera);
  Area changed(was.size());
  for (size_t i = 0; i < changed.size(); ++i) changed[i] = was[i] != is[i];
  return changed;
}

}  // namespace cei3d
