// SPDX-License-Identifier: Apache-2.0
// The networks of one training step, and the distances that they give for points.
#pragma once

#include <functional>
#include <span>

#include "core/base/aligned.h"
#include "model/field/field.h"
#include "model/field/field_pass.h"
#include "model/field/gradients.h"

namespace cei3d {

// What all tasks of a step share and none of them changes.
struct GeometryNetworks {
  const Device& device;
  const Field& sdf;
  MlpWeights sdf_weights, radiance_weights;
  int levels;  // hash levels in use
};

// Work memory of one task.
class PointValues {
 public:
  static constexpr int kBlock = 512;  // points evaluated at a time

  explicit PointValues(const FieldConfig& sdf);
  // Signed distances at points x, any number of them. out: #x
  void eval(const GeometryNetworks&, std::span<const Vec3f> x, std::span<float> out);
  // Gradients of a loss of the distances at points x, at most kBlock. d_value(i, distance): the derivative of
  // the loss by the distance at x[i].
  void gradient(const GeometryNetworks&, std::span<const Vec3f> x,
                const std::function<float(int, float)>& d_value, ChunkGradients& out);

 private:
  int rows_;  // outputs of the field
  FieldPass pass_;
  AlignedVector<float> points_;  // [kBlock / 32][3][32]
};

}  // namespace cei3d
