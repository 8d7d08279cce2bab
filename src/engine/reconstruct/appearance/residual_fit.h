// SPDX-License-Identifier: Apache-2.0
// Trains the network of a coupled color (model/scene/residual.h), on training images or on what shading
// leaves of them.
#pragma once

#include <vector>

#include "core/base/clock.h"
#include "core/base/progress.h"
#include "engine/reconstruct/appearance/linear_split.h"
#include "model/scene/residual.h"

namespace cei3d {

struct ResidualOptions {
  double seconds = 0;  // time limit; 0: no limit, `steps` decides
  Clock clock = steady_seconds;
  int steps = 1500;
  // Adam rates, which decay to a hundredth. Features of fields without hash tables are not trained: that
  // would take hours.
  float rate = 2.5e-3f;        // of the network
  float table_rate = 1e-2f;    // of the hash tables of the features
  float feature_rate = 3e-3f;  // of the layers of the features
  uint64_t seed = 1;
};

// sdf: whose features, or a copy of them that is trained, the network reads. samples: as for the appearance
// stage. radiance: #samples, linear, what the network's output is added to; empty: nothing. Error:
// interrupted.
Residual fit_residual(const Device&, const std::shared_ptr<const Field>& sdf, const SurfaceSamples& samples,
                      std::vector<Vec3f> radiance, const ResidualOptions&, Progress&);

}  // namespace cei3d
