// SPDX-License-Identifier: Apache-2.0
// What a joint descent begins from where nothing is known. [paper sec. 5.1]
#pragma once

#include "engine/reconstruct/joint/joint_descent.h"
#include "engine/reconstruct/presets.h"

namespace cei3d {

// The distance to a sphere; an albedo of about .5 everywhere; light from all sides by 128 gray lobes on a
// Fibonacci lattice, of random sharpness and brightness, whose power is 2 pi a channel; a gloss whose lobe,
// a Gaussian about the normal, has a random sharpness between 95 and 125, and a specular albedo between .18
// and .26.
JointObject start_values(const Device&, const Preset&, uint64_t seed);

}  // namespace cei3d
