// SPDX-License-Identifier: Apache-2.0
// Distant light as a picture to distant light as lobes.
#pragma once

#include "core/base/progress.h"
#include "core/compute/device.h"
#include "core/image/image.h"
#include "model/light/envmap.h"
#include "model/light/sg_mixture.h"

namespace cei3d {

struct LobeFitOptions {
  int lobes = 128;
  int steps = 800;  // of Adam
  int height = 32;  // the picture is averaged down to this many rows first
  // Sharpness of the lobe that the light will be seen through; 0: a mirror. The fit then looks at the light
  // blurred by that lobe, so that detail nobody can see (the spikes of a deconvolved light) takes no lobes
  // away.
  float seen_through = 0;
};

// Lobes that start on a Fibonacci sphere with sharpness lobes / 2 and descend on the squared error of square
// roots, weighted by solid angle.
SgMixture fit_lobes(const Device&, const Image& lat_long, const LobeFitOptions& = {}, EnvUp up = EnvUp::z,
                    const Progress& progress = Progress());

}  // namespace cei3d
