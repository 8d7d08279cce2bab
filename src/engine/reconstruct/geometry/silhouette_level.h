// SPDX-License-Identifier: Apache-2.0
// The level of the trained field that is the surface. Parts thinner than the soft shell of volume rendering
// are rendered half transparent, and the zero level may miss them; the masks give the true coverage.
#pragma once

#include "core/base/progress.h"
#include "core/compute/device.h"
#include "engine/reconstruct/pixels.h"
#include "model/field/field.h"

namespace cei3d {

// The level, unit frame, at which the share of rays through silhouette pixels that meet the surface
// equals the mean alpha of those pixels. Positive: the object grows. Silhouette pixels are those with an
// alpha between 0 and 1, or, where masks are black and white, those on both sides of their borders. Zero when
// there are too few; always within +-max_level.
float silhouette_level(const Device&, const Field& sdf, const PixelStore&, float max_level, uint64_t seed,
                       const Progress& progress = Progress());

}  // namespace cei3d
