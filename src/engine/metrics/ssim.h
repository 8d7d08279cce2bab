// SPDX-License-Identifier: Apache-2.0
// Structural similarity. [Wang et al. 2004]
#pragma once

#include <optional>

#include "core/image/area.h"
#include "core/image/image.h"

namespace cei3d {

// Mean over channels and window positions; 11 x 11 Gaussian windows (sigma 1.5) completely inside the image,
// biased variances, K1 = 0.01, K2 = 0.03, range 1. a, b: RGB of one size >= 11 x 11, display-encoded. Error:
// other sizes.
double ssim(const Image& a, const Image& b);

// SSIM of the windows whose center is in the area; none if there are none. Windows at its border include
// pixels outside.
std::optional<double> ssim_in_area(const Image& a, const Image& b, const Area& area);

}  // namespace cei3d
