// SPDX-License-Identifier: Apache-2.0
// The images of a capture as pixels for training.
#pragma once

#include <vector>

#include "core/base/progress.h"
#include "engine/reconstruct/pixels.h"
#include "model/scene/normalization.h"
#include "model/scene/view.h"

namespace cei3d {

struct TrainingViews {
  PixelStore train, held_out;
  std::vector<Camera> given_train, given_held_out;  // their cameras as the capture has them
  // Exposures of the training views by their cameras' notes, for each channel; their geometric mean is 1.
  // Empty: some view has none, or all are alike.
  std::vector<Vec3f> noted_exposures;
  // Of a pixel at the object's center, mean over the given cameras of the training views, unit frame.
  double footprint = 0;

  void set_cameras(const RefinedCameras&, const Normalization&);  // in place of the given ones
};

// Errors: no training image shows the object; an image cannot be read; interrupted.
TrainingViews load_training_views(const Capture&, const ImageSource&, const Normalization&, Progress&);

}  // namespace cei3d
