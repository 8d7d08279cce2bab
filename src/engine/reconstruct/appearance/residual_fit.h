// SPDX-License-Identifier: Apache-2.0
// Trains the correction network (model/scene/residual.h) on the difference between training images and
// shading.
#pragma once

#include <optional>

#include "core/base/clock.h"
#include "core/base/progress.h"
#include "engine/reconstruct/appearance/linear_split.h"
#include "model/scene/residual.h"
#include "model/scene/scene.h"

namespace cei3d {

struct ResidualOptions {
  // Time limit of shading all samples and training, which gets at least half of it; 0: no limit, `steps`
  // decides.
  double seconds = 0;
  Clock clock = steady_seconds;
  int steps = 1500;
  // Adam rates, which decay to a hundredth. Features of fields without hash tables are not trained: that
  // would take hours.
  float rate = 2.5e-3f;        // of the network
  float table_rate = 1e-2f;    // of the hash tables of the features
  float feature_rate = 3e-3f;  // of the layers of the features
  uint64_t seed = 1;
  // The network is all that the object shows: it is trained on the colors themselves, by all views, and kept.
  bool alone = false;
};

// Result of the fit. During the first fifth of the training every eighth view is held back: if its pixels do
// not gain, there is no network (spot: only noise is left to explain).
struct ResidualFit {
  std::optional<Residual> residual;
  std::optional<Explained> explained;  // on the views held back, after that fifth; none: no such view
};
// scene: without a correction network. samples: as for the appearance stage. views: #samples, index of the
// camera. Error: interrupted.
ResidualFit fit_residual(const Device&, const Scene& scene, const SurfaceSamples& samples,
                         std::span<const uint16_t> views, const ResidualOptions&, Progress&);

}  // namespace cei3d
