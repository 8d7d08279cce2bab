// SPDX-License-Identifier: Apache-2.0
// Fits light lobes to an environment image.
#pragma once

#include "core/base/progress.h"
#include "core/compute/device.h"
#include "core/image/image.h"
#include "model/light/envmap.h"
#include "model/light/sg_mixture.h"

namespace cei3d {

struct LobeFitOptions {
  int lobes = 128;
  int steps = 800;  // steps of Adam
  int height = 32;  // the image is averaged down to this number of rows first
  // Sharpness of the reflection lobe through which the light will be seen; 0: a mirror. The fit then compares
  // both lights blurred by that lobe, so that no lobes are spent on invisible detail (spikes of a deconvolved
  // light).
  float seen_through = 0;
};

// Lobes that start on a Fibonacci sphere with sharpness lobes / 2 and descend on the squared error of square
// roots, weighted by solid angle, with refined colors (refine_colors.h).
SgMixture fit_lobes(const Device&, const Image& lat_long, const LobeFitOptions& = {}, EnvUp up = EnvUp::z,
                    const Progress& progress = Progress());

}  // namespace cei3d
