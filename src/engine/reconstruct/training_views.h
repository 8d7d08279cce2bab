// SPDX-License-Identifier: Apache-2.0
// The capture's pictures as training needs them.
#pragma once

#include "core/base/progress.h"
#include "engine/reconstruct/pixels.h"
#include "model/scene/normalization.h"
#include "model/scene/view.h"

namespace cei3d {

struct TrainingViews {
  PixelStore train, held_out;
  double footprint = 0;  // of a pixel at the object's center, mean over the training views, unit-sphere units
};

// Errors: no training picture shows the object; a picture cannot be read; interrupted.
TrainingViews load_training_views(const Capture&, const ImageSource&, const Normalization&, Progress&);

}  // namespace cei3d
