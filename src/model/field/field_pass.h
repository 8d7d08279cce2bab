// SPDX-License-Identifier: Apache-2.0
// Forward and backward pass of one chunk of points through a field, for trainers; other code calls
// Field::eval().
#pragma once

#include "model/field/field.h"

namespace cei3d {

class FieldPass {
 public:
  FieldPass(const FieldConfig& config, int capacity, int columns);

  // points: [panels][3][32]. levels: hash levels in use, coarse to fine; features of the others are zero.
  void forward(const Device&, const Field&, const MlpWeights&, const float* points, int n, int levels,
               int outputs);
  const float* output() const { return mlp_.output(); }
  float* d_output() { return mlp_.d_output(); }
  // network_gradient: added to. d_encoding: [panels * columns][encoding_rows][32], written; for the hash
  // tables, see ChunkGradients.
  void backward(const Device&, const MlpWeights&, int n, int levels, float* network_gradient,
                float* d_encoding);

 private:
  void add_sphere(const float* points, int n);
  int active_rows(int levels) const;
  FieldConfig config_;
  int columns_;
  MlpPass mlp_;
};

// Panels [panels][3][32] of points; the last panel is padded with the origin.
void points_to_panels(const Vec3f* points, int n, float* panels);

}  // namespace cei3d
