// SPDX-License-Identifier: Apache-2.0
// An object without light and material, for comparison: its color is a network over position and direction
// alone. [paper sec. 5, "w/o PPD"] docs/method.md#coupled-color
#pragma once

#include "engine/reconstruct/stage.h"

namespace cei3d {

// The stages after the surface. make_finer_mesh: run where the plan has a finer mesh.
std::vector<Stage> coupled_stages(const Plan&, double finer_mesh_length, double color_length,
                                  const Stage::Run& make_finer_mesh);

// A field of the mean color of each point over the samples that see it. Error: interrupted.
std::shared_ptr<const Field> mean_colors(const Device&, const SurfaceSamples&, const FieldConfig&,
                                         uint64_t seed, Progress&);

}  // namespace cei3d
