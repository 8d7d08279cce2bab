// SPDX-License-Identifier: Apache-2.0
// Selects a part from prompts in one view by a segmentation network.
#pragma once

#include <functional>
#include <vector>

#include "engine/render/render.h"
#include "engine/segment/compete.h"
#include "engine/segment/propagate.h"
#include "engine/segment/sam_memory.h"

namespace cei3d {

struct SamPartRequest {
  PropagateRequest views;  // cameras to choose from, the clicked one among them, and the prompts
  // Images of the views for the network: RGBA, linear, straight alpha, of the camera's size. Null: renders of
  // the albedo, which have no shadows or highlights that look like borders.
  std::function<Image(int view)> image;
  std::vector<Seed> certain;  // #handlers, points that the user marked; empty: none
  GraphOptions graph{};       // on which the border is placed
};

// Scores like those of grow() (#handlers, [0, 1], to be interpolated by ScoredPoints), and the views that
// were used. random_walk() moves the border of the votes to where the color changes. Pure; results do not
// depend on threads. Errors: no network (with what to do), nothing found at the clicks, cancelled.
PropagateResult sam_part(const Device&, const Scene&, const SamPartRequest&, SamMemory&, Progress&);

}  // namespace cei3d
