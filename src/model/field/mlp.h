// SPDX-License-Identifier: Apache-2.0
// A small fully connected network over panels of samples: its values, or those with the spatial gradient of
// output 0 as jets, whose four columns are four panels.
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
  // has derivative columns; those of the others stay zero. Networks of jets have no output activation.
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
  // What a hidden layer keeps, in panels of its outputs. "Wide": of what the next layer reads, which may have
  // the network's input appended.
  struct Hidden {
    AlignedVector<float> z;  // before the activation; of jets the activation's first derivative there
    AlignedVector<float> h;  // after it; wide
    // The rest is filled by passes of jets only.
    AlignedVector<float> second;     // second derivative of the activation
    AlignedVector<float> d_h, d_z;   // derivatives of output 0 by h and z; d_h is wide
    AlignedVector<float> loss_by_z;  // derivative by z of a loss of the gradient
  };
  struct Batch {  // samples, in whole panels
    int n, panels, active_inputs;
  };

  bool jets() const { return columns_ > 1; }
  int last() const { return int(layers_.size()) - 1; }
  int in_use(const Batch& s, int layer) const { return layer == 0 ? s.active_inputs : layers_[layer].in; }
  size_t offset(int layer) const;  // of its weights among the gradients
  void activate(const Device&, int layer, const Batch&);
  void activate_grad(const Device&, int layer, const Batch&, float* d);
  void append_input(const float* x, int x_stride, float* h, int layer, const Batch&) const;
  // The spatial gradient of output 0, and a loss of it back.
  void differentiate(const Device&, const MlpWeights&, const Batch&);
  void differentiate_grad(const Device&, const MlpWeights&, const Batch&, float* gradient, float* d_input);

  MlpConfig config_;
  std::vector<MlpLayer> layers_;
  int columns_;
  AlignedVector<float> x_, y_, y_raw_, d_y_, d_a_, d_b_, d_x_;
  AlignedVector<float> gradient_, loss_by_gradient_;  // of output 0 by the input; of a loss by that
  AlignedVector<float> ones_;                         // [panels][1][32]
  std::vector<Hidden> hidden_;
};

}  // namespace cei3d
