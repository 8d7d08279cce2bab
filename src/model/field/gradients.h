// SPDX-License-Identifier: Apache-2.0
// Sums the gradients of many chunks of points in an order that does not depend on the number of threads.
#pragma once

#include <vector>

#include "core/base/aligned.h"
#include "model/field/field.h"
#include "model/field/optimizer.h"

namespace cei3d {

// Gradients of one chunk.
struct ChunkGradients {
  int padded = 0, columns = 1;      // number of samples (a multiple of 32), and panels per group of 32
  AlignedVector<float> points;      // [padded / 32][3][32]
  AlignedVector<float> d_encoding;  // [padded / 32 * columns][encoding_rows][32]
  std::vector<float> network;       // MlpWeights::gradient_size()

  void reset(const FieldConfig& config, size_t network_size, int n, int columns);
};

// Adds the chunks, in order, to the optimizer's gradients: layers one parameter per thread, tables one level
// per thread.
void accumulate_gradients(const Device&, const Field&, const std::vector<ChunkGradients>&, int levels,
                          Optimizer&);

// For the layers alone: adds the `network` gradients in chunk order. params: "layer0/weight", ...
void accumulate_layers(const ParamSet& params, const std::vector<const std::vector<float>*>& network,
                       Optimizer&);

}  // namespace cei3d
