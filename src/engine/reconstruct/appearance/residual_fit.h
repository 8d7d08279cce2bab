// SPDX-License-Identifier: Apache-2.0
// Trains the residual (model/scene/residual.h) on what the physical model leaves of the training pictures.
#pragma once

#include <optional>

#include "core/base/clock.h"
#include "core/base/progress.h"
#include "engine/reconstruct/appearance/linear_split.h"
#include "model/scene/residual.h"
#include "model/scene/scene.h"

namespace cei3d {

struct ResidualOptions {
  // For the shading of all samples and the training, which gets half at least; 0: no limit, the steps count.
  double seconds = 0;
  Clock clock = steady_seconds;
  int steps = 1500;
  // Adam's; they fall to a hundredth. Of the network, and of the features' tables and layers. Fields without
  // tables keep the features they have: they would take hours.
  float rate = 2.5e-3f, table_rate = 1e-2f, feature_rate = 3e-3f;
  uint64_t seed = 1;
};

// scene: the object without residual. samples: as for the appearance stage; views: #samples. For the first
// fifth every eighth view is kept apart, to judge by: there is no residual where its pixels do not gain
// (spot: what light and material leave there is noise), and nothing where there is no such view. Error:
// interrupted.
struct ResidualFit {
  std::optional<Residual> residual;
  std::optional<Explained> explained;  // of the views kept apart, after that fifth
};
ResidualFit fit_residual(const Device&, const Scene& scene, const SurfaceSamples& samples,
                         std::span<const uint16_t> views, const ResidualOptions&, Progress&);

}  // namespace cei3d
