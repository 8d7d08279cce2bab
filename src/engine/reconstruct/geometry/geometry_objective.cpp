// SPDX-License-Identifier: Apache-2.0
#include "engine/reconstruct/geometry/geometry_objective.h"

#include <algorithm>
#include <cmath>

#include "core/math/psnr.h"
#include "core/math/rng.h"

namespace cei3d {

namespace {

constexpr float kAnchorWidth = 0.02f;    // Huber width of the distance to the start shape
constexpr float kSamplesPerRay = 4;      // about as many are usual
constexpr float kHeldSamplesPerRay = 2;  // samples of every ray that the held points weigh as much as

}  // namespace

double GeometryStats::psnr() const {
  return psnr_of_mse(std::max(squared_error / double(std::max<int64_t>(rays, 1)), 1e-12));
}

GeometryStats& operator+=(GeometryStats& a, const GeometryStats& b) {
  a.color += b.color;
  a.mask += b.mask;
  a.eikonal += b.eikonal;
  a.loss += b.loss;
  a.squared_error += b.squared_error;
  a.kept += b.kept;
  a.candidates += b.candidates;
  a.rays += b.rays;
  return a;
}

GeometryObjective::GeometryObjective(const GeometryOptions& options, const GeometrySchedule& schedule,
                                     const DistanceGrid& anchor)
    : weights_(options.loss),
      schedule_(schedule),
      anchor_(anchor),
      per_ray_(1.0f / float(options.rays)),
      per_sample_(per_ray_ / kSamplesPerRay) {}

void GeometryObjective::backward(const RayBatch& batch, const RaySamples& samples, VolumeRenderer& renderer,
                                 GeometryStats& stats) const {
  std::vector<Vec3f> d_pixels;
  for (int r = 0; r < batch.count(); ++r) d_pixels.push_back(color_loss(batch, r, renderer, stats));
  renderer.backward_composite(batch, samples, d_pixels);
  for (int r = 0; r < batch.count(); ++r)
    for (int i = samples.first[r]; i < samples.first[r + 1]; ++i)
      sample_losses(i, batch.empty[r], renderer, stats);
  stats.kept += samples.count();
  stats.rays += batch.count();
}

Vec3f GeometryObjective::color_loss(const RayBatch& batch, int r, const VolumeRenderer& renderer,
                                    GeometryStats& stats) const {
  const Vec3f error = renderer.pixels()[r] - batch.targets[r].srgb;
  const auto loss = huber(error, weights_.huber_width);
  stats.color += loss.value;
  stats.loss += per_ray_ * loss.value;
  stats.squared_error += dot(error, error) / 3;
  // Reported, but no loss: coverage is always a little below one, so that such a loss would never come to
  // rest (docs/decisions/0020).
  stats.mask += std::abs(renderer.coverage()[r] - batch.targets[r].alpha);
  return loss.gradient * per_ray_;
}

void GeometryObjective::sample_losses(int i, bool empty, VolumeRenderer& renderer,
                                      GeometryStats& stats) const {
  const JetView jets = renderer.jets();
  const JetGradView d_jets = renderer.d_jets();
  const auto unit = eikonal(jets.gradient(i));
  const float unit_weight = weights_.eikonal * per_sample_;
  d_jets.add_gradient(i, unit.gradient * unit_weight);
  stats.eikonal += unit.value;
  stats.loss += unit_weight * unit.value;
  const auto add = [&](float weight, LossValue<float> loss) {
    d_jets.add_value(i, weight * loss.gradient);
    stats.loss += weight * loss.value;
  };
  if (empty) add(weights_.empty * schedule_.inv_s * per_ray_, empty_push(jets.value(i), schedule_.inv_s));
  if (schedule_.anchor > 0)
    add(schedule_.anchor * per_ray_, huber(jets.value(i) - anchor_.at(renderer.point(i)), kAnchorWidth));
}

LossValue<float> GeometryObjective::hold(Vec3f x, float distance, int count) const {
  const float weight = kHeldSamplesPerRay * schedule_.anchor / float(count);
  const LossValue<float> loss = huber(distance - anchor_.at(x), kAnchorWidth);
  return {weight * loss.value, weight * loss.gradient};
}

std::vector<Vec3f> hold_points(const DistanceGrid& start, uint64_t seed, int64_t step, int count) {
  constexpr float kNear = 0.08f;  // distance of points that are near the surface
  constexpr int kTries = 16;
  std::vector<Vec3f> x(static_cast<size_t>(count));
  for (int i = 0; i < count; ++i) {
    Rng rng(seed ^ 0x401d, uint64_t(step), uint64_t(i));
    for (int k = 0; k < kTries && (k == 0 || std::abs(start.at(x[i])) > kNear); ++k)
      x[i] = Vec3f{rng.uniform(), rng.uniform(), rng.uniform()} * 2.0f - Vec3f{1, 1, 1};
  }
  return x;
}

}  // namespace cei3d
