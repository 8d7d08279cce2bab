// SPDX-License-Identifier: Apache-2.0
// For tests: a correction that changes what is seen.
#pragma once

#include <memory>

#include "core/math/rng.h"
#include "model/scene/scene.h"

namespace cei3d {

// A network of a field like the albedo's, whose last weights are random numbers of standard
// deviation `size`.
inline std::shared_ptr<const Residual> random_residual(const Field& albedo, float size) {
  FieldConfig config = albedo.config();
  config.outputs = 4;
  config.output_activation = Activation::none;
  auto residual = std::make_shared<Residual>(make_residual(std::make_shared<Field>(config, 5), 3));
  Param& last = residual->params.all()[residual->params.all().size() - 2];
  for (size_t i = 0; i < last.count(); ++i) last.value[i] = size * Rng(5, 5, i).normal();
  return residual;
}

}  // namespace cei3d
