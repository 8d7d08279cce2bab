// SPDX-License-Identifier: Apache-2.0
// Paint without handler points, the paper's ablation: the albedo field of the object itself is trained on the
// scribble. Only the surface that the painted view shows beside the scribble is kept at its color.
#pragma once

#include <memory>
#include <vector>

#include "core/base/progress.h"
#include "engine/edit/stroke.h"

namespace cei3d {

// Points with known albedo, linear.
struct ColorSamples {
  std::vector<Vec3f> positions, colors;
  size_t size() const { return positions.size(); }
};

// The surface that the strokes' views show beside the strokes, with its present albedo.
ColorSamples beside_strokes(const Device&, const Scene&, const std::vector<Camera>& views,
                            const std::vector<Region>& painted);

// A copy of the base's albedo field trained on both, half of each batch from either. Errors: the shape was
// edited, cancelled.
std::shared_ptr<const Field> relearn(const Device&, const Scene&, const ColorSamples& painted,
                                     const ColorSamples& beside, uint64_t seed, Progress&);

}  // namespace cei3d
