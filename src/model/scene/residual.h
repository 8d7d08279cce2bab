// SPDX-License-Identifier: Apache-2.0
// The correction ("residual" in code and files): the part of the photographs that light and material do not
// explain. It is added to the shaded radiance: under the reconstructed light, on surface that no edit moved
// or added. Where an edit changed color or material, it is scaled as the shading changed. The albedo does not
// depend on it. It is a blend of pictures of what is left, or, of a coupled color and in older projects, a
// small network over features of the point, the normal and the view direction.
// docs/method.md#correction-by-photographs
#pragma once

#include <memory>
#include <span>
#include <vector>

#include "core/base/aligned.h"
#include "model/field/field.h"
#include "model/field/field_pass.h"
#include "model/field/gradients.h"
#include "model/geometry/shape/hit.h"
#include "model/scene/residual_images.h"

namespace cei3d {

struct Residual {
  // Outputs 1.. are features of a point: the SDF, or a copy of it that was trained further. Null: there is no
  // network.
  std::shared_ptr<const Field> features;
  MlpConfig network;  // 3 outputs: linear radiance
  ParamSet params;
  // Rotation of a turning light: the network gets directions in the frame of the light.
  Mat3f room_from_object = Mat3f::identity();
  std::shared_ptr<const ResidualImages> images;  // null: none
};

inline constexpr int kResidualLayers = 3, kMaxResidualLayers = 8;

// A network whose output is zero everywhere.
Residual make_residual(std::shared_ptr<const Field> features, uint64_t seed, int layers = kResidualLayers);

// Work memory of one chunk of hits.
class ResidualPass {
 public:
  static constexpr int kMaxHits = 512;  // hits in a chunk, at most
  ResidualPass(const FieldConfig& features, const MlpConfig& network);

  // Returns the number of samples: hits rounded up to a panel. hits: in shape version 0, their directions in
  // the frame of the light.
  int forward(const Device&, const Field& features, const MlpWeights& feature_weights,
              const MlpWeights& weights, std::span<const Hit> hits);
  Vec3f output(int hit) const;
  void set_output_grad(int hit, Vec3f d_output);  // dL/d(output); zero for padding
  // gradient: [MlpWeights::gradient_size()], added to.
  void backward(const Device&, const MlpWeights& weights, int samples, float* gradient);
  // Gradient of the features; call after backward(). Written, not added to.
  void backward_features(const Device&, const MlpWeights& feature_weights, int samples, ChunkGradients&);

 private:
  FieldConfig features_;
  FieldPass values_;
  MlpPass network_;
  AlignedVector<float> points_, directions_, jets_, d_jets_, d_input_;
};

// Linear radiance to add: #hits. hits: in shape version 0. smooth: without the details that pictures have of
// the surface.
std::vector<Vec3f> residual_at(const Device&, const Residual&, std::span<const Hit> hits,
                               bool smooth = false);

}  // namespace cei3d
