// SPDX-License-Identifier: Apache-2.0
// Which level of the trained field is the surface. Volume rendering shows what is thinner than its soft shell
// as half transparent; the zero level may miss it. The silhouettes say how much matter there is.
#pragma once

#include "core/base/progress.h"
#include "core/compute/device.h"
#include "engine/reconstruct/pixels.h"
#include "model/field/field.h"

namespace cei3d {

// The level, unit-sphere units, at which as many rays through pixels half covered in the pictures meet the
// surface as those say, on average. Positive: the object grows. Where masks are black and white, by the
// pixels on both sides of their borders. Zero when those are too few; never farther from zero than `most`.
float silhouette_level(const Device&, const Field& sdf, const PixelStore&, float most, uint64_t seed,
                       const Progress& progress = Progress());

}  // namespace cei3d
