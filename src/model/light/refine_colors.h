// SPDX-License-Identifier: Apache-2.0
// Colors of lobes at which a surface under them looks as under an image of the light.
#pragma once

#include "core/image/image.h"
#include "model/light/envmap.h"
#include "model/light/sg_mixture.h"

namespace cei3d {

// Least squares on the irradiance and on two blurs, as wide as reflections at roughness .2 and .3, over 600
// directions; colors stay positive. Axes and sharpnesses stay. A fit to square roots of radiance, in which
// a sun does not drown the sky, loses up to 60 % of the energy. Image: latitude-longitude, linear.
SgMixture refine_colors(SgMixture, const Image& lat_long, EnvUp up = EnvUp::z);

}  // namespace cei3d
