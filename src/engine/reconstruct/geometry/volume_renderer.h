// SPDX-License-Identifier: Apache-2.0
// Renders samples of rays by the signed distance field and the radiance network, and takes gradients of the
// pixels back to both networks.
#pragma once

#include <span>
#include <vector>

#include "core/base/aligned.h"
#include "core/compute/kernels/panel.h"
#include "core/math/composite.h"
#include "core/math/volume.h"
#include "engine/reconstruct/geometry/geometry_options.h"
#include "engine/reconstruct/geometry/point_values.h"
#include "engine/reconstruct/geometry/ray_batch.h"

namespace cei3d {

MlpConfig radiance_config(const GeometryOptions&);

// Work memory of one task: one batch of rays at a time, forward, then backward.
class VolumeRenderer {
 public:
  explicit VolumeRenderer(const GeometryOptions&);

  void forward(const GeometryNetworks&, const GeometrySchedule&, const RayBatch&, const RaySamples&);
  std::span<const Vec3f> pixels() const { return pixels_; }      // #rays, display-encoded
  std::span<const float> coverage() const { return coverage_; }  // #rays
  // #rays: mean over the light of a ray; 0 where more than half of it is the background's.
  std::span<const float> depths() const { return depths_; }
  JetView jets() const { return {jet_.output(), rows_}; }  // #samples: distance and its gradient
  Vec3f point(int sample) const { return load_point<float>(points_.data(), sample); }

  // The first part of the adjoint: back through compositing and opacities. Losses of the distances and of
  // their gradients can be added to d_jets() between the two parts. d_pixels: #rays
  void backward_composite(const RayBatch&, const RaySamples&, std::span<const Vec3f> d_pixels);
  JetGradView d_jets() { return {jet_.d_output(), rows_}; }
  // The second part of the adjoint: back through the networks. Overwrites both gradients; radiance: layers,
  // as MlpWeights has them.
  void backward_networks(const GeometryNetworks&, const RayBatch&, ChunkGradients& sdf,
                         std::vector<float>& radiance);

 private:
  void place(const GeometrySchedule&, const RayBatch&, const RaySamples&);
  const float* turns(const RayBatch& batch) const {
    return batch.room_from_object.empty() ? nullptr : rotations_.data();
  }
  void composite(const GeometrySchedule&, const RayBatch&, const RaySamples&);
  Vec3f color(int sample) const { return load_point<float>(color_.output(), sample); }

  FieldConfig sdf_;
  int rows_;        // outputs of the field
  int inputs_;      // of the radiance network
  int padded_ = 0;  // samples, rounded up to whole panels
  FieldPass jet_;
  MlpPass color_;
  AlignedVector<float> points_, directions_;  // [panels][3][32]
  AlignedVector<float> rotations_;            // [panels][9][32]; of the light, where it turns
  AlignedVector<float> d_color_input_;        // [panels][inputs_][32]
  std::vector<NeusSample<float>> alphas_;     // #samples
  std::vector<SampleWeight<float>> weights_;  // #samples
  std::vector<Vec3f> pixels_;
  std::vector<float> coverage_, depths_;
};

}  // namespace cei3d
