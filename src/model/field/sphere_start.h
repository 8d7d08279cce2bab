// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "model/field/field.h"

namespace cei3d {

// Geometric initialization: random weights with which output 0 of a network over frequencies is about the
// distance to a sphere around the origin. Hidden weights keep the length of what they are applied to, the
// last ones add up, and all that is not the point itself has no weight at first. The bias is such that
// output 0 is zero on the sphere in the mean. Fields that are a sphere by FieldConfig::sphere_radius stay as
// they are. [Atzmon and Lipman 2020; Yariv et al. 2020]
void begin_as_sphere(const Device&, Field&, float radius, uint64_t seed);

}  // namespace cei3d
