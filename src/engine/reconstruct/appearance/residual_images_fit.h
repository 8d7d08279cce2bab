// SPDX-License-Identifier: Apache-2.0
// Makes the residual images of an object (model/scene/residual_images.h) from its training photographs.
// docs/method.md#correction-by-photographs
#pragma once

#include <cstdint>
#include <memory>
#include <optional>

#include "core/base/clock.h"
#include "core/base/progress.h"
#include "engine/reconstruct/pixels.h"
#include "model/light/light_turns.h"
#include "model/scene/scene.h"

namespace cei3d {

struct ResidualImagesOptions {
  // Of all images. Of photographs with more, blocks of pixels become one.
  size_t max_pixels = 24000000;
  // Time limit: if, by the first photograph, four in ten would take longer, blocks become larger; when it is
  // over, the rest of the photographs is left out. 0: none.
  double seconds = 0;
  Clock clock = steady_seconds;
  uint64_t seed = 1;
};

struct ResidualImagesFit {
  // Null: on pixels of each photograph the images of all others gain less than 3 % (where only noise is left
  // to explain).
  std::shared_ptr<const ResidualImages> images;
  Explained explained;  // on those pixels
};
// What part of a blend is added, by its angle, is what explains pixels of each photograph best by the images
// of all others. scene: without a correction. turns: of the cameras; null: the light stands still. Error:
// interrupted.
ResidualImagesFit fit_residual_images(const Device&, const Scene& scene, const PixelStore&,
                                      const LightTurns* turns, const ResidualImagesOptions&, Progress&);

}  // namespace cei3d
