// SPDX-License-Identifier: Apache-2.0
// For tests: a small distance field that has learned the distances of a body that is nearly a sphere.
#pragma once

#include <cmath>

#include "core/math/rng.h"
#include "model/field/field.h"

namespace cei3d {

// distance(x): what the field learns, at points around the sphere of that radius. spread: standard deviation
// of the distances of three quarters of the points from the sphere; that of the others is seven times as
// large.
template <class Distance>
Field learned_distances(const Device& device, float radius, float spread, Distance&& distance) {
  FieldConfig c;
  c.encoding = {0, 8, 8, 64, 14};
  c.width = 32;
  c.activation = Activation::softplus;
  c.outputs = 1;
  c.sphere_radius = radius;
  Field field(c, 1);
  FieldTrainer trainer(field, {});
  constexpr int kSteps = 250, kPoints = 4096;
  for (int step = 0; step < kSteps; ++step) {
    std::vector<Vec3f> x;
    for (uint64_t i = 0; i < kPoints; ++i) {
      Rng rng(3, uint64_t(step), i);
      const Vec3f d = normalize(Vec3f{rng.normal(), rng.normal(), rng.normal()});
      x.push_back(d * (radius + (i % 4 ? spread : 7 * spread) * rng.normal()));
    }
    const auto loss = [&](int begin, int end, const float* out, float* d_out) {
      for (int i = begin; i < end; ++i)
        d_out[i - begin] = 2 * (out[i - begin] - distance(x[size_t(i)])) / kPoints;
    };
    trainer.step(device, x, loss, std::pow(0.01f, float(step) / kSteps));
  }
  return field;
}

}  // namespace cei3d
