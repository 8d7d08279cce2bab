// SPDX-License-Identifier: Apache-2.0
// Paint without handler points, as the paper's ablation has it: the one color field that the object has
// learns the scribble itself. What the painted view shows beside the scribble is held as it was; nothing
// holds the rest.
#pragma once

#include <memory>
#include <vector>

#include "core/base/progress.h"
#include "engine/edit/stroke.h"

namespace cei3d {

// Where base color is known: points and what it is there, linear.
struct ColorSamples {
  std::vector<Vec3f> positions, colors;
  size_t size() const { return positions.size(); }
};

// What the strokes' views show beside the strokes, with its present base color.
ColorSamples beside_strokes(const Device&, const Scene&, const std::vector<Camera>& views,
                            const std::vector<Region>& painted);

// A copy of the base's field that has learned both, half of each step's points from either. Errors: the
// object's shape was edited, cancelled.
std::shared_ptr<const Field> relearn(const Device&, const Scene&, const ColorSamples& painted,
                                     const ColorSamples& beside, uint64_t seed, Progress&);

}  // namespace cei3d
