// SPDX-License-Identifier: Apache-2.0
// A small fully connected network over panels of samples: values, or jets, whose four columns are four
// panels.
#pragma once

#include <vector>

#include "core/base/aligned.h"
#include "core/compute/device.h"
#include "model/field/params.h"

namespace cei3d {

enum class Activation { none, relu, elu, softplus, sigmoid };

struct MlpConfig {
  int inputs = 3;
  int hidden_layers = 1, width = 64;
  int skip_layer = -1;  // hidden layer before which the input is appended again, divided by sqrt 2; -1: none
  Activation activation = Activation::relu;
  float softplus_beta = 100;
  int outputs = 3;
  Activation output_activation = Activation::none;
};

struct MlpLayer {
  int in, out;
  bool concat;  // the network's input is appended to this layer's input
};
std::vector<MlpLayer> mlp_layers(const MlpConfig&);

// Adds "layer0/weight" [out][in], "layer0/bias" [out], ... to params. Weights are uniform with variance 2 /
// (3 in), a third of He's initialization, which avoids large outputs of untrained softplus and ELU networks;
// biases are zero.
void add_mlp_params(const MlpConfig&, ParamSet& params, uint64_t seed);

// Weights in the layouts that the passes need, made once per step.
class MlpWeights {
 public:
  MlpWeights(const MlpConfig& config, const ParamSet& params);
  const MlpConfig& config() const { return config_; }
  const std::vector<MlpLayer>& layers() const { return layers_; }
  const float* weight(int layer) const { return weights_[layer].data(); }         // [out][in]
  const float* transposed(int layer) const { return transposed_[layer].data(); }  // [in][out]
  const float* bias(int layer) const { return biases_[layer].data(); }
  size_t gradient_size() const;  // floats: for each layer weight [out][in], then bias [out]

 private:
  MlpConfig config_;
  std::vector<MlpLayer> layers_;
  std::vector<std::vector<float>> weights_, transposed_, biases_;
};

// Work memory and the two passes of one chunk of samples.
class MlpPass {
 public:
  // capacity: samples, a multiple of 32. columns: 1 for values, 4 for jets. Of a jet's outputs only output 0
  // has derivative columns; those of the others stay zero.
  MlpPass(const MlpConfig& config, int capacity, int columns);

  float* input() { return x_.data(); }  // [panels * columns][inputs][32], filled by the caller
  // active_inputs: input rows that may be non-zero; the others are skipped. outputs: number of first outputs
  // to compute.
  void forward(const Device&, const MlpWeights&, int n, int active_inputs, int outputs);
  const float* output() const { return y_.data(); }  // [panels * columns][outputs of the config][32]
  float* mutable_output() { return y_.data(); }      // for what is added to the outputs of the network
  float* d_output() { return d_y_.data(); }  // same shape; filled by the caller; overwritten by backward
  // gradient: [MlpWeights::gradient_size()], added to. d_input: same shape as input, written; may be null.
  void backward(const Device&, const MlpWeights&, int n, int active_inputs, float* gradient, float* d_input);

 private:
  int panels(int n) const { return n / kPanel * columns_; }
  void activate(const Device&, int layer, int n);
  void activate_grad(const Device&, int layer, int n, float* d);

  MlpConfig config_;
  std::vector<MlpLayer> layers_;
  int columns_;
  AlignedVector<float> x_, y_, y_raw_, d_y_, d_a_, d_b_, d_x_;
  std::vector<AlignedVector<float>> z_, h_;  // before and after each hidden layer's activation
};

}  // namespace cei3d
