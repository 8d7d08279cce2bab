// SPDX-License-Identifier: Apache-2.0
#include "engine/edit/refit_field.h"

#include <algorithm>
#include <cmath>

#include "core/base/cancel.h"
#include "core/math/loss.h"
#include "core/math/rng.h"
#include "engine/edit/point_distance.h"
#include "model/geometry/shape/point_index.h"
#include "model/geometry/shape/sdf_normals.h"

namespace cei3d {
namespace {

constexpr float kHeldFrom = 0.04f;  // distance from all that moved from which the field is held
// Standard deviation of points around the surface where the field is held.
constexpr float kHeldSpread = 0.01f;
constexpr float kSpreads[] = {0.002f, 0.01f, 0.05f};  // standard deviations of the other points, in turns
constexpr float kLastRate = 0.02f;
constexpr float kRounded = 2e-4f;  // errors below which the L1 loss is rounded off

class Refit {
 public:
  Refit(const Device& device, const Field& before, const DeformedPoints& given, const RefitOptions& options)
      : device_(device),
        before_(before),
        options_(options),
        distance_(given.points),
        vacated_(given.vacated) {
    std::vector<Vec3f> changed = given.vacated;
    for (size_t i = 0; i < given.moved.size(); ++i)
      if (given.moved[i]) moved_.push_back(given.points.positions[i]);
    changed.insert(changed.end(), moved_.begin(), moved_.end());
    if (moved_.empty() || vacated_.empty())
      fail("No handler point has moved, so the field cannot follow. Drag farther.");
    const PointIndex near(changed, kHeldFrom);
    for (size_t i = 0; i < given.moved.size(); ++i) {
      const Vec3f p = given.points.positions[i];
      if (!near.any_within(p, kHeldFrom, [](size_t) { return true; })) held_.push_back(p);
    }
  }

  void step(FieldTrainer& trainer, int step, float rate) {
    choose(step);
    const int outputs = before_.config().outputs;
    const float weight = 1 / float(options_.batch);
    const auto loss = [&](int begin, int end, const float* out, float* d_out) {
      for (int i = begin; i < end; ++i) {
        const size_t at = size_t(i - begin) * outputs;
        d_out[at] = weight * huber(out[at] - target(size_t(i)), kRounded).gradient;
      }
    };
    trainer.step(device_, points_, loss, rate);
  }

 private:
  // Half of the points around the moved surface, a quarter where it was, a quarter where the field is held.
  void choose(int step) {
    points_.clear();
    const auto count = size_t(options_.batch);
    for (size_t i = 0; i < count; ++i) {
      Rng rng(options_.seed, uint64_t(step), i);
      const bool holds = i % 4 == 3 && !held_.empty();
      const std::vector<Vec3f>& from = holds ? held_ : i % 4 == 2 ? vacated_ : moved_;
      const float spread = holds ? kHeldSpread : kSpreads[i / 4 % std::size(kSpreads)];
      points_.push_back(from[rng.below(uint32_t(from.size()))] +
                        Vec3f{rng.normal(), rng.normal(), rng.normal()} * spread);
    }
    was_.assign(count, 0);
    if (held_.empty()) return;
    std::vector<Vec3f> held;
    for (size_t i = 3; i < count; i += 4) held.push_back(points_[i]);
    const std::vector<float> values = first_output(device_, before_, held);
    for (size_t k = 0; k < values.size(); ++k) was_[3 + 4 * k] = values[k];
  }

  float target(size_t i) const {
    if (i % 4 == 3 && !held_.empty()) return was_[i];
    return options_.distance == SurfaceDistance::with_sign ? distance_.signed_distance(points_[i])
                                                           : distance_.l1_distance(points_[i]);
  }

  const Device& device_;
  const Field& before_;
  RefitOptions options_;
  PointDistance distance_;
  std::vector<Vec3f> moved_, vacated_, held_;  // points around which samples are drawn
  std::vector<Vec3f> points_;                  // of the step
  std::vector<float> was_;                     // value of the field before, where it is held
};

}  // namespace

Field refit_field(const Device& device, const Field& before, const DeformedPoints& given,
                  const RefitOptions& options, const Progress& progress) {
  Field field = before;
  const bool has_tables = field.config().encoding.levels > 0;
  FieldTrainer trainer(
      field, {.encoding_rate = options.table_rate, .network_rate = has_tables ? 0 : options.layer_rate});
  Refit refit(device, before, given, options);
  for (int step = 0; step < options.steps; ++step) {
    check_cancelled(progress, "Deforming was interrupted; nothing was changed.");
    refit.step(trainer, step, std::pow(kLastRate, float(step) / float(options.steps)));
  }
  return field;
}

std::vector<Vec3f> on_zero_set(const Device& device, const Field& sdf, std::vector<Vec3f> x) {
  constexpr int kRounds = 4;
  constexpr float kMaxStep = 0.01f, kMinLength = 0.3f;
  for (int round = 0; round < kRounds; ++round) {
    const std::vector<float> values = first_output(device, sdf, x);
    const std::vector<Vec3f> gradients = sdf_gradients(device, sdf, x);
    for (size_t i = 0; i < x.size(); ++i) {
      const float per_length = max(length(gradients[i]), kMinLength);
      x[i] = x[i] - gradients[i] * (clamp(values[i] / per_length, -kMaxStep, kMaxStep) / per_length);
    }
  }
  return x;
}

}  // namespace cei3d
