// SPDX-License-Identifier: Apache-2.0
// The derivatives of the shading loss of polishing by values of the distance field, on which the normals of
// hits depend.
#pragma once

#include <vector>

#include "engine/reconstruct/appearance/surface_polish.h"

namespace cei3d {

class NormalGrads {
 public:
  // appearance: of the surface of `input`; light and material are fixed, the albedo is trained along in a
  // copy.
  NormalGrads(const Device&, const AppearanceInput&, const AppearanceResult& appearance, const PolishOptions&,
              const Progress&);

  // Derivatives of the loss of a random batch of samples. Positions of hits are held constant. Valid until
  // the next call.
  ValueGradSpans at(const Field& sdf, int step);

  // The albedo and the moments of its optimizer, which at() changes.
  void save(Tensors& out) const;
  void load(const Tensors& in);

  // The last batch: hits on the field, and which samples they are.
  std::span<const Hit> hits() const { return hits_; }
  std::span<const uint32_t> samples() const { return batch_; }

 private:
  void choose_batch(int step);
  void fit_albedo(const std::vector<Vec3f>& positions, const std::vector<ShadingTerms<float>>&);

  const Device& device_;
  SurfaceSamples samples_;
  const MaterialField& material_;
  PolishOptions options_;
  Field albedo_;
  FieldTrainer trainer_;
  Lighting lighting_;
  std::vector<uint32_t> batch_;
  std::vector<Hit> hits_;
  std::vector<Vec3f> colors_, d_radiance_;  // albedo of the hits, dL/d(radiance)
  std::vector<Vec3f> directions_;
  std::vector<float> edges_;  // of the hits' normals (sdf_normals)
  std::vector<Vec3f> points_;
  std::vector<float> value_grads_;
};

}  // namespace cei3d
