// SPDX-License-Identifier: Apache-2.0
// What light and material cannot explain: a small network over the features of the distance field, the normal
// and the view, whose output is added to what the physical model sends out. It belongs to the object as it
// was photographed: an edit's region, another light and the base colour never see it. [architecture 1.2]
#pragma once

#include <span>
#include <vector>

#include "model/field/field.h"
#include "model/field/field_pass.h"
#include "model/geometry/hit.h"

namespace cei3d {

struct Residual {
  MlpConfig network;  // 3 outputs: linear radiance
  ParamSet params;
};

// Starts as nothing: zero everywhere.
Residual make_residual(const FieldConfig& sdf, uint64_t seed);

// Work memory of one chunk of hits.
class ResidualPass {
 public:
  static constexpr int kMost = 512;  // hits
  ResidualPass(const FieldConfig& sdf, const MlpConfig& network);

  // Returns the number of samples, hits rounded up to a panel. hits: in the shape that was photographed.
  int forward(const Device&, const Field& sdf, const MlpWeights& sdf_weights, const MlpWeights& weights,
              std::span<const Hit> hits);
  Vec3f output(int hit) const;
  void set_slope(int hit, Vec3f slope);  // dL/d(output); of padding, zero
  // gradient: [MlpWeights::gradient_size()], added to.
  void backward(const Device&, const MlpWeights& weights, int samples, float* gradient);

 private:
  FieldConfig sdf_;
  FieldPass values_;
  MlpPass network_;
  std::vector<float> points_, directions_, jets_;
};

// #hits
std::vector<Vec3f> residual_at(const Device&, const Field& sdf, const Residual&, std::span<const Hit> hits);

}  // namespace cei3d
