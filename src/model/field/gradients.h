// SPDX-License-Identifier: Apache-2.0
// Gradients of a field from many chunks, brought together in an order that does not depend on threads.
#pragma once

#include <vector>

#include "core/base/aligned.h"
#include "model/field/field.h"
#include "model/field/optimizer.h"

namespace cei3d {

// What one chunk leaves behind for the step.
struct ChunkGradients {
  int padded = 0, columns = 1;      // samples (multiple of 32) and panels a group
  AlignedVector<float> points;      // [padded / 32][3][32]
  AlignedVector<float> d_encoding;  // [padded / 32 * columns][encoding_rows][32]
  std::vector<float> network;       // MlpWeights::gradient_size()

  void reset(const FieldConfig& config, size_t network_size, int n, int columns);
};

// Sums chunk after chunk into the optimizer's gradients: layers by parameter, tables by level (an owner a
// level).
void accumulate_gradients(const Device&, const Field&, const std::vector<ChunkGradients>&, int levels,
                          Optimizer&);

// For the layers alone: adds the `network` gradients in chunk order. params: "layer0/weight", ...
void accumulate_layers(const ParamSet& params, const std::vector<const std::vector<float>*>& network,
                       Optimizer&);

}  // namespace cei3d
