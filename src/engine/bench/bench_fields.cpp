// SPDX-License-Identifier: Apache-2.0
// Training steps of distance fields alone: values and gradients at random points, the eikonal loss back to
// the parameters, Adam. bench/peer_torch times the same in PyTorch.
#include "core/base/cancel.h"
#include "core/math/loss.h"
#include "core/math/rng.h"
#include "engine/bench/bench.h"
#include "engine/reconstruct/presets.h"
#include "engine/session/stopwatch.h"
#include "model/field/field.h"

namespace cei3d {
namespace {

constexpr int kPoints = 4096;

std::vector<Vec3f> random_points() {
  std::vector<Vec3f> points(kPoints);
  for (size_t i = 0; i < points.size(); ++i) {
    Rng rng(1, 0, i);
    for (int c = 0; c < 3; ++c) points[i][c] = 2 * rng.uniform() - 1;
  }
  return points;
}

void step(const Device& device, FieldTrainer& trainer, std::span<const Vec3f> points) {
  const float weight = 1.0f / float(points.size());
  trainer.accumulate_jets(device, points, [&](int, const FieldJet& jet) {
    return FieldJet{weight * absolute(jet.value).gradient, eikonal(jet.gradient).gradient * weight};
  });
  trainer.update(device);
}

BenchFigure step_of(const Device& device, const std::string& preset, const std::string& what, int repeats,
                    const Progress& progress) {
  Field field(preset_by_name(preset).geometry.sdf, 1);
  FieldTrainer trainer(field, {});
  const std::vector<Vec3f> points = random_points();
  std::vector<double> times;
  for (int k = 0; k <= repeats; ++k) {  // the first one is a warm-up
    check_cancelled(progress, "The measurement was interrupted.");
    Stopwatch watch;
    step(device, trainer, points);
    if (k > 0) times.push_back(1e6 * watch.lap() / kPoints);
  }
  return {"fields", "", "distance field step, " + what, "us/point", false, spread_of(times, false), {}};
}

}  // namespace

std::vector<BenchFigure> bench_fields(const Device& device, int repeats, Progress& progress) {
  progress.report({"fields", 0.1, -1, ""});
  return {step_of(device, "paper", "8 layers of 512", repeats, progress),
          step_of(device, "fast", "hash grid", 10 * repeats, progress)};
}

}  // namespace cei3d
