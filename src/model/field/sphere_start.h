// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "model/field/field.h"

namespace cei3d {

// Geometric initialization: random weights with which output 0 of a network over frequencies is about the
// distance to a sphere around the origin. Hidden layers keep the length of their input, the last layer adds
// up its input, and of the encoding only the point itself has weights that are not 0. The bias is such that
// the mean of output 0 over the sphere is 0. Fields that are a sphere by FieldConfig::sphere_radius stay as
// they are. [Atzmon and Lipman 2020; Yariv et al. 2020]
void begin_as_sphere(const Device&, Field&, float radius, uint64_t seed);

}  // namespace cei3d
