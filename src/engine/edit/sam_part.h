// SPDX-License-Identifier: Apache-2.0
// A part from clicks in one view, by a segmentation network.
#pragma once

#include <filesystem>
#include <vector>

#include "engine/render/render.h"
#include "engine/segment/propagate.h"

namespace cei3d {

struct SamPartRequest {
  std::filesystem::path networks;  // folder of networks and runtime: installed_sam(), or the user's own
  PropagateRequest views;          // cameras to choose from, the clicked one among them, and the clicks
  int threads = 0;                 // of the network; 0: every core
};

// Scores as grow() gives them: #handlers of the scene, [0, 1], to be interpolated (ScoredPoints); and which
// views were used. The network sees the base color in each view, which has no shadows and highlights to be
// mistaken for borders; its votes then end where the color does (random_walk). Pure, and the same for any
// number of threads. Errors: no network here (what to do), nothing found at the clicks, cancelled.
PropagateResult sam_part(const Device&, const Scene&, const SamPartRequest&, Progress&);

}  // namespace cei3d
