// SPDX-License-Identifier: Apache-2.0
// The loss of a batch of rays and its gradient: color error, unit length of the distance's gradient, empty
// rays free of surface, and in the beginning closeness to the start shape. [paper eq. 16]
#pragma once

#include <span>
#include <vector>

#include "core/math/loss.h"
#include "engine/reconstruct/geometry/geometry_options.h"
#include "engine/reconstruct/geometry/ray_batch.h"
#include "engine/reconstruct/geometry/volume_renderer.h"
#include "engine/reconstruct/start/prefit.h"

namespace cei3d {

// Sums over rays and their samples, unweighted unless said.
struct GeometryStats {
  double color = 0;          // Huber loss of the color, per ray
  double mask = 0;           // |coverage - alpha of the pixel|, per ray; no part of the loss
  double eikonal = 0;        // per sample
  double loss = 0;           // weighted sum of all losses but that behind ValueGradSpans: what descent lowers
  double squared_error = 0;  // per ray, mean over channels; display-encoded
  int64_t kept = 0;          // samples
  int64_t candidates = 0;    // whose distance was computed
  int64_t rays = 0;
  double psnr() const;  // dB
};
GeometryStats& operator+=(GeometryStats& a, const GeometryStats& b);

class GeometryObjective {
 public:
  // anchor: the start shape, if the schedule holds it; must outlive the objective.
  GeometryObjective(const GeometryOptions&, const GeometrySchedule&, const DistanceGrid& anchor);

  // Leaves the gradients by the jets and colors of the batch in the renderer, which has rendered it.
  void backward(const RayBatch&, const RaySamples&, VolumeRenderer&, GeometryStats&) const;
  // The loss at one of `count` points at which the field is held at the start shape. Rays are not sampled
  // where the surface is gone, so only such points can bring it back.
  LossValue<float> hold(Vec3f x, float distance, int count) const;

 private:
  Vec3f color_loss(const RayBatch&, int ray, const VolumeRenderer&, GeometryStats&) const;
  void sample_losses(int sample, bool empty, VolumeRenderer&, GeometryStats&) const;

  GeometryLosses weights_;
  GeometrySchedule schedule_;
  const DistanceGrid& anchor_;
  float per_ray_;     // 1 / rays of the step
  float per_sample_;  // about 1 / samples of the step
};

// Random points near the surface of a start shape, where it is held.
std::vector<Vec3f> hold_points(const DistanceGrid& start, uint64_t seed, int64_t step, int count);

}  // namespace cei3d
