// SPDX-License-Identifier: Apache-2.0
// For tests of schedules: how long units of work take.
#pragma once

#include "engine/reconstruct/rates.h"

namespace cei3d {

// Seconds of each kind of work of preset "fast", measured on two cores.
inline constexpr Rates kTestRates{.sdf_step = 1.5e-3,
                                  .trial_step = 1.5e-3,
                                  .albedo_step = 3.5e-3,
                                  .mesh = 2.5e-5,
                                  .hit_traced = 1.2e-6,
                                  .hit_shaded = 6e-7};

}  // namespace cei3d
