// SPDX-License-Identifier: Apache-2.0
// The images of a capture as pixels for training.
#pragma once

#include "core/base/progress.h"
#include "engine/reconstruct/pixels.h"
#include "model/scene/normalization.h"
#include "model/scene/view.h"

namespace cei3d {

struct TrainingViews {
  PixelStore train, held_out;
  // Exposures of the training views by their cameras' notes, for each channel; their geometric mean is 1.
  // Empty: some view has none, or all are alike.
  std::vector<Vec3f> noted_exposures;
  double footprint = 0;  // of a pixel at the object's center, mean over the training views, unit frame
};

// Errors: no training image shows the object; an image cannot be read; interrupted.
TrainingViews load_training_views(const Capture&, const ImageSource&, const Normalization&, Progress&);

}  // namespace cei3d
