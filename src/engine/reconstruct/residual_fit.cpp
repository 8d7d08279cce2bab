// SPDX-License-Identifier: Apache-2.0
#include "engine/reconstruct/residual_fit.h"

#include <chrono>
#include <cmath>

#include "core/base/parallel.h"
#include "core/base/pool.h"
#include "core/math/rng.h"
#include "engine/reconstruct/display_loss.h"
#include "engine/render/scene_light.h"
#include "model/field/gradients.h"
#include "model/field/optimizer.h"
#include "model/scene/appearance.h"

namespace cei3d {

namespace {

constexpr int kBatch = 8192;

double now() {
  return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

// What the physical model sends out.
std::vector<Vec3f> physical(const Device& device, const Scene& scene, std::span<const Hit> hits) {
  const Shading shading = SceneLight(device, scene, scene_transports(scene)).shade(hits, appearance_at(device, scene, hits));
  std::vector<Vec3f> out(hits.size());
  for (size_t i = 0; i < out.size(); ++i) out[i] = shading.diffuse[i] + shading.specular[i];
  return out;
}

}  // namespace

Residual fit_residual(const Device& device, const Scene& scene, const SurfaceSamples& samples,
                      const ResidualOptions& options, Progress& progress) {
  const double start = now();
  const Field& sdf = *scene.sdf;
  const std::vector<Vec3f> sent = physical(device, scene, samples.hits);
  Residual residual = make_residual(sdf.config(), options.seed);
  Optimizer optimizer;
  optimizer.add(residual.params, "", {options.rate});
  const MlpWeights sdf_weights(mlp_config(sdf.config()), sdf.params());
  Pool<ResidualPass> passes([&] { return std::make_unique<ResidualPass>(sdf.config(), residual.network); });
  constexpr int kChunks = kBatch / ResidualPass::kMost;
  std::vector<std::vector<float>> gradients(kChunks);
  for (int step = 0; !progress.cancelled(); ++step) {
    const double u = std::max(double(step) / options.steps, options.seconds > 0 ? (now() - start) / options.seconds : 0.0);
    if (u >= 1) break;
    const MlpWeights weights(residual.network, residual.params);
    parallel_for(kChunks, [&](int chunk) {
      std::vector<uint32_t> chosen(ResidualPass::kMost);
      std::vector<Hit> hits(chosen.size());
      for (size_t i = 0; i < chosen.size(); ++i) {
        Rng rng(options.seed, uint64_t(step), uint64_t(chunk) * chosen.size() + i);
        chosen[i] = rng.below(uint32_t(samples.hits.size()));
        hits[i] = samples.hits[chosen[i]];
      }
      gradients[chunk].assign(weights.gradient_size(), 0.0f);
      passes.with([&](ResidualPass& pass) {
        const int n = pass.forward(device, sdf, sdf_weights, weights, hits);
        for (int i = 0; i < n; ++i) {
          const uint32_t s = chosen[i];
          const bool clipped = !samples.saturated.empty() && samples.saturated[s];
          const Vec3f got = sent[s] + pass.output(i);
          Vec3f slope{0, 0, 0};
          for (int c = 0; c < 3 && !clipped; ++c)
            slope[c] = display_loss_slope(got[c], samples.colors[s][c]) / float(kBatch);
          pass.set_slope(i, slope);
        }
        pass.backward(device, weights, n, gradients[chunk].data());
      });
    });
    std::vector<const std::vector<float>*> all;
    for (const auto& g : gradients) all.push_back(&g);
    accumulate_layers(residual.params, all, optimizer);
    optimizer.step(device, float(std::pow(0.01, u)));
    if (step % 50 == 0) progress.report({"residual", 0.99, -1, ""});
  }
  return residual;
}

}  // namespace cei3d
