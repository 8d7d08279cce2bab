// SPDX-License-Identifier: Apache-2.0
// Geometry edits of the implicit surface: a copy of the distance field is fine-tuned until its zero set is
// the surface of the moved handler points. [paper sec. 4.4, eq. 18; docs/method.md#changes-of-shape]
#pragma once

#include <vector>

#include "core/base/progress.h"
#include "core/compute/device.h"
#include "model/field/field.h"
#include "model/geometry/shape/handlers.h"

namespace cei3d {

enum class SurfaceDistance {
  with_sign,  // the field is compared with signed distances
  l1,         // with min_h |s - h|_1, as the paper prints it; the field loses its inside
};

struct RefitOptions {
  SurfaceDistance distance = SurfaceDistance::with_sign;
  int steps = 500;           // [paper sec. 5.1]
  int batch = 4096;          // points per step
  float table_rate = 2e-3f;  // Adam rate of hash tables, at the beginning
  float layer_rate = 5e-4f;  // of the layers of a network without tables; those behind tables are held
  uint64_t seed = 1;
};

// Points of a deformed surface.
struct DeformedPoints {
  HandlerPoints points;        // after the deformation
  std::vector<uint8_t> moved;  // #points
  std::vector<Vec3f> vacated;  // where the moved points were
};

// Where nothing has moved, the field is held. Error: nothing has moved; interrupted.
Field refit_field(const Device&, const Field& before, const DeformedPoints&, const RefitOptions&,
                  const Progress&);

// Points near the zero set moved onto it: #x.
std::vector<Vec3f> on_zero_set(const Device&, const Field& sdf, std::vector<Vec3f> x);

}  // namespace cei3d
