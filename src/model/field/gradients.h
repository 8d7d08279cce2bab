// SPDX-License-Identifier: Apache-2.0
// Gradients of a field from many chunks, summed in an order that does not depend on threads.
#pragma once

#include <vector>

#include "core/base/aligned.h"
#include "model/field/field.h"
#include "model/field/optimizer.h"

namespace cei3d {

// The gradients of one chunk of samples; its hash tables' are scattered from d_encoding when chunks are
// summed.
struct ChunkGradients {
  int padded = 0;                   // samples, rounded up to a multiple of 32
  int columns = 1;                  // panels per group of 32 samples: 1 values, 4 jets
  AlignedVector<float> points;      // [padded / 32][3][32]
  AlignedVector<float> d_encoding;  // [padded / 32 * columns][encoding_rows][32]
  std::vector<float> network;       // MlpWeights::gradient_size()

  void reset(const FieldConfig& config, size_t network_size, int n, int columns);
};

// Adds the gradients of all chunks to the optimizer's, in chunk order: layers by parameter, tables by level
// (one task per level).
void accumulate_gradients(const Device&, const Field&, const std::vector<ChunkGradients>&, int levels,
                          Optimizer&);

// For the layers alone: adds the `network` gradients in chunk order. params: "layer0/weight", ...
void accumulate_layers(const ParamSet& params, const std::vector<const std::vector<float>*>& network,
                       Optimizer&);

}  // namespace cei3d
