// SPDX-License-Identifier: Apache-2.0
// The correction network: what light and material cannot explain of the photographs. A small network over
// features of the point, the normal and the view direction; its output is added to the shaded radiance, on
// surface as it was photographed only. It is not used in the regions of edits or under another light, and the
// albedo does not depend on it. docs/method.md#correction-network
#pragma once

#include <memory>
#include <span>
#include <vector>

#include "core/base/aligned.h"
#include "model/field/field.h"
#include "model/field/field_pass.h"
#include "model/field/gradients.h"
#include "model/geometry/shape/hit.h"

namespace cei3d {

struct Residual {
  // Its outputs 1.. are features of a point: those of the SDF, or of a copy that was trained further.
  std::shared_ptr<const Field> features;
  MlpConfig network;  // 3 outputs: linear radiance
  ParamSet params;
  Mat3f room_from_object =
      Mat3f::identity();  // of the light, where it turns: the network sees directions in its frame
};

inline constexpr int kResidualLayers = 3, kMaxResidualLayers = 8;

// A network whose output is zero everywhere.
Residual make_residual(std::shared_ptr<const Field> features, uint64_t seed, int layers = kResidualLayers);

// Work memory of one chunk of hits.
class ResidualPass {
 public:
  static constexpr int kMost = 512;  // hits
  ResidualPass(const FieldConfig& features, const MlpConfig& network);

  // Returns the number of samples: hits rounded up to a panel. hits: in shape version 0, their directions in
  // the frame of the light.
  int forward(const Device&, const Field& features, const MlpWeights& feature_weights,
              const MlpWeights& weights, std::span<const Hit> hits);
  Vec3f output(int hit) const;
  void set_slope(int hit, Vec3f slope);  // dL/d(output); of padding, zero
  // gradient: [MlpWeights::gradient_size()], added to.
  void backward(const Device&, const MlpWeights& weights, int samples, float* gradient);
  // After backward(): the features' own gradient, written.
  void backward_features(const Device&, const MlpWeights& feature_weights, int samples, ChunkGradients&);

 private:
  FieldConfig features_;
  FieldPass values_;
  MlpPass network_;
  AlignedVector<float> points_, directions_, jets_, d_jets_, d_input_;
};

// Linear radiance, #hits.
std::vector<Vec3f> residual_at(const Device&, const Residual&, std::span<const Hit> hits);

}  // namespace cei3d
