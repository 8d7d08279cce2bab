// SPDX-License-Identifier: Apache-2.0
#include "engine/edit/relearn.h"

#include <algorithm>

#include "core/base/cancel.h"
#include "core/base/error.h"
#include "core/math/rng.h"
#include "engine/edit/albedo_branch.h"
#include "model/scene/appearance.h"

namespace cei3d {
namespace {

constexpr int kSteps = 500, kBatch = 2048;  // kSteps: the paper's

// A batch drawn with replacement, half from either set; a function of seed and step.
ColorSamples batch_of(const ColorSamples& painted, const ColorSamples& beside, uint64_t seed, int step) {
  ColorSamples b{std::vector<Vec3f>(kBatch), std::vector<Vec3f>(kBatch)};
  for (int i = 0; i < kBatch; ++i) {
    const ColorSamples& from = i % 2 && beside.size() > 0 ? beside : painted;
    const uint32_t k = Rng(seed, step, i).below(uint32_t(from.size()));
    b.positions[i] = from.positions[k];
    b.colors[i] = from.colors[k];
  }
  return b;
}

}  // namespace

ColorSamples beside_strokes(const Device& device, const Scene& scene, const std::vector<Camera>& views,
                            const std::vector<Region>& painted) {
  std::vector<Hit> hits;
  for (const Camera& view : views)
    for (const Hit& h : trace_view(device, scene, view, 1).hits)
      if (std::none_of(painted.begin(), painted.end(),
                       [&](const Region& r) { return r.contains(h.position, h.normal); }))
        hits.push_back(h);
  ColorSamples s;
  s.colors = appearance_at(device, scene, hits).albedo;
  for (const Hit& h : hits) s.positions.push_back(h.position);
  return s;
}

std::shared_ptr<const Field> relearn(const Device& device, const Scene& scene, const ColorSamples& painted,
                                     const ColorSamples& beside, uint64_t seed, Progress& progress) {
  if (!scene.shape_versions.empty())
    fail(
        "The shape of the object was edited, and its single albedo field cannot follow that; use another "
        "routing.");
  auto field = std::make_shared<Field>(*scene.albedo);
  FieldTrainer trainer(*field, {.encoding_rate = 1e-2f, .network_rate = 2e-3f});
  for (int step = 0; step < kSteps; ++step) {
    check_cancelled(progress, "Painting was interrupted; nothing was changed.");
    const float fraction = float(step) / kSteps;
    const ColorSamples batch = batch_of(painted, beside, seed, step);
    trainer.step(device, batch.positions, absolute_difference(batch.colors), cosine_decay(fraction));
    if (step % 50 == 0) progress.report({"paint", 0.2 + 0.8 * fraction, -1, ""});
  }
  return field;
}

}  // namespace cei3d
