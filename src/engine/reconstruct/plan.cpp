// SPDX-License-Identifier: Apache-2.0
#include "engine/reconstruct/plan.h"

#include <algorithm>

#include "core/math/scalar.h"

namespace cei3d {

namespace {

constexpr double kPixelsASecond = 100000;  // of training, that the appearance stage gets time for: from
constexpr double kLeastAppearance = 20, kMostAppearance = 60;  // to so many seconds; more brings nothing
constexpr double kRefinement = 36;                             // seconds of one of the albedo, with its hits
constexpr double kMostPolish = 60;                             // seconds a round; more brings nothing
constexpr double kBetweenRounds = 7;                           // Plan::between
constexpr int kPolishSteps = 600, kPolishStepsUntimed = 300;   // a round, at most
constexpr double kMostResidual = 90;                           // seconds of training, or
constexpr int kResidualSteps = 9000, kResidualStepsUntimed = 4500;  // steps,
constexpr double kResidualHitsASecond = 4500;       // on so many hits for each second of the run,
constexpr size_t kResidualHitsUntimed = 1000000;    // or so many; shading
constexpr double kHitSeconds = 4e-6;                // one takes so long
constexpr double kSaving = 8, kSavingShare = 0.03;  // seconds; of the run: what is left at the end
constexpr double kResidualRun = 120;                // seconds; shorter runs spend them on the surface
constexpr double kFinishing = 15;     // seconds of a mesh of 384 cells, with what its vertices see,
constexpr double kFinishedRun = 300;  // in runs of so many

}  // namespace

Plan plan_of(const ReconstructOptions& options, const Preset& preset, size_t pixels) {
  Plan p;
  p.iterations = options.iterations > 0 ? options.iterations : preset.iterations;
  const double t = options.seconds;
  const bool has_finer = preset.finished.resolution > preset.meshing.resolution;
  const double appearance =
      preset.stretch * std::clamp(double(pixels) / kPixelsASecond, kLeastAppearance, kMostAppearance);
  if (t <= 0 || options.iterations > 0) {
    p.appearance = t > 0 ? std::min(appearance, 0.2 * t) : 0;
    p.rounds = p.iterations >= 1000 ? 2 : 0;
    p.finish = has_finer && p.rounds > 0;
    p.polish_steps = kPolishStepsUntimed;
    p.residual_steps = std::min(kResidualStepsUntimed, p.iterations / 2);
    p.residual_hits = std::min(preset.residual_hits, kResidualHitsUntimed);
    return p;
  }
  p.between = kBetweenRounds * preset.stretch;
  p.rounds = t >= 180 ? 2 : t >= 45 ? 1 : 0;
  p.polish_steps = kPolishSteps;
  p.residual_steps = t >= kResidualRun ? kResidualSteps : 0;
  p.polish = std::min(kMostPolish * preset.stretch, 0.1 * t);
  while (p.rounds * (p.polish + p.between) > 0.3 * t) --p.rounds;
  p.appearance = std::min(appearance, 0.2 * t);
  p.residual_hits = std::min({preset.residual_hits, size_t(kResidualHitsASecond * t), pixels});
  p.finish = has_finer && t >= kFinishedRun;
  if (p.finish) p.finishing = kFinishing * square(preset.finished.resolution / 384.0) * preset.stretch;
  if (t >= kResidualRun)
    p.residual = std::min(kMostResidual, 0.1 * t) + kHitSeconds * preset.stretch * double(p.residual_hits);
  p.saving = std::max(kSaving, kSavingShare * t);
  const double wanted = double(pixels) / kPixelsASecond - kMostAppearance,
               affordable = 0.1 * t / preset.stretch;
  p.refinements = std::max(0, int(std::min(wanted, affordable) / kRefinement));
  p.refinement = kRefinement * preset.stretch;
  const double polishing = p.rounds * (p.polish + p.between);
  const double last = p.appearance + p.refinements * p.refinement + p.finishing + p.residual + p.saving;
  p.geometry = std::max(0.35 * t, t - polishing - last);
  return p;
}

}  // namespace cei3d
