// SPDX-License-Identifier: Apache-2.0
#include "engine/reconstruct/appearance/residual_fit.h"

#include <array>
#include <cmath>

#include "core/base/cancel.h"
#include "core/base/parallel.h"
#include "core/base/pool.h"
#include "core/math/loss.h"
#include "core/math/rng.h"
#include "model/field/gradients.h"
#include "model/field/optimizer.h"

namespace cei3d {

namespace {

constexpr int kChunks = 16, kBatch = kChunks * ResidualPass::kMaxHits;  // pixels per step
constexpr double kWarmUp = 0.05;  // share of the steps at rising rates: large first steps leave dead units

class ResidualTrainer {
 public:
  ResidualTrainer(const Device& device, const std::shared_ptr<const Field>& sdf,
                  const SurfaceSamples& samples, std::vector<Vec3f> radiance, const ResidualOptions& options)
      : device_(device),
        samples_(samples),
        seed_(options.seed),
        warm_up_(kWarmUp * options.steps),
        radiance_(std::move(radiance)),
        features_(std::make_shared<Field>(*sdf)),
        features_learn_(features_->config().encoding.levels > 0),
        residual_(make_residual(features_learn_ ? features_ : sdf, options.seed)),
        passes_([this] { return std::make_unique<ResidualPass>(features_->config(), residual_.network); }) {
    radiance_.resize(samples.hits.size(), Vec3f{0, 0, 0});
    optimizer_.add(residual_.params, "", {.rate = options.rate});
    if (features_learn_) {
      optimizer_.add(features_->params(), "encoding/", {.rate = options.table_rate, .skip_zero = true});
      optimizer_.add(features_->params(), "layer", {.rate = options.feature_rate});
    }
  }

  void step(double rate) {
    const MlpWeights weights(residual_.network, residual_.params),
        feature_weights(mlp_config(features_->config()), features_->params());
    std::array<std::vector<float>, kChunks> gradients;
    std::vector<ChunkGradients> feature_gradients(features_learn_ ? kChunks : 0);
    parallel_for(kChunks, [&](int chunk) {
      gradients[chunk].assign(weights.gradient_size(), 0.0f);
      passes_.with([&](ResidualPass& pass) {
        const int n = learn(pass, feature_weights, weights, choose(chunk), gradients[chunk].data());
        if (features_learn_) pass.backward_features(device_, feature_weights, n, feature_gradients[chunk]);
      });
    });
    std::vector<const std::vector<float>*> all;
    for (const auto& g : gradients) all.push_back(&g);
    accumulate_layers(residual_.params, all, optimizer_);
    if (features_learn_)
      accumulate_gradients(device_, *features_, feature_gradients, features_->config().encoding.levels,
                           optimizer_);
    ++steps_;
    optimizer_.step(device_, float(rate * std::min(1.0, steps_ / warm_up_)));
  }

  Residual take() { return std::move(residual_); }

 private:
  std::vector<uint32_t> choose(int chunk) const {
    std::vector<uint32_t> out(ResidualPass::kMaxHits);
    for (size_t i = 0; i < out.size(); ++i)
      out[i] = Rng(seed_, uint64_t(steps_), uint64_t(chunk) * out.size() + i)
                   .below(uint32_t(samples_.hits.size()));
    return out;
  }

  // Returns the number of samples of the pass.
  int learn(ResidualPass& pass, const MlpWeights& feature_weights, const MlpWeights& weights,
            const std::vector<uint32_t>& chosen, float* gradient) {
    std::vector<Hit> hits;
    for (const uint32_t s : chosen) hits.push_back(hit(s));
    const int n = pass.forward(device_, *features_, feature_weights, weights, hits);
    for (int i = 0; i < n; ++i) pass.set_output_grad(i, output_grad(chosen[i], pass.output(i)));
    pass.backward(device_, weights, n, gradient);
    return n;
  }

  // Network input of a sample: under a turning light, directions relative to the light.
  Hit hit(uint32_t sample) const {
    const Hit& h = samples_.hits[sample];
    const TurnedHits& turned = samples_.turned;
    return turned.turns ? with_rotated_directions(h, turned.turns->room_from_object[turned.views[sample]])
                        : h;
  }

  // dL/d(output of the network).
  Vec3f output_grad(uint32_t sample, Vec3f residual) const {
    Vec3f out;
    for (int c = 0; c < 3; ++c)
      out[c] = display_loss(radiance_[sample][c] + residual[c], samples_.colors[sample][c],
                            samples_.is_clipped(sample, c))
                   .gradient /
               float(kBatch);
    return out;
  }

  const Device& device_;
  const SurfaceSamples& samples_;
  uint64_t seed_;
  double warm_up_;  // steps
  std::vector<Vec3f> radiance_;
  std::shared_ptr<Field> features_;
  bool features_learn_;
  Residual residual_;
  Pool<ResidualPass> passes_;
  Optimizer optimizer_;
  int steps_ = 0;
};

// Trains at rates that decay to a hundredth. seconds: time limit; 0: none.
void train(ResidualTrainer& trainer, int steps, double seconds, const Clock& clock, Progress& progress) {
  const double start = clock();
  for (int step = 0; step < steps; ++step) {
    check_cancelled(progress);
    const double by_clock = seconds > 0 ? (clock() - start) / seconds : 0;
    const double u = std::max(double(step) / steps, by_clock);
    if (u >= 1) break;
    trainer.step(std::pow(0.01, u));
    if (step % 50 == 0) progress.report({"residual", u, -1, ""});
  }
}

}  // namespace

Residual fit_residual(const Device& device, const std::shared_ptr<const Field>& sdf,
                      const SurfaceSamples& samples, std::vector<Vec3f> radiance,
                      const ResidualOptions& options, Progress& progress) {
  progress.report({"residual", 0, -1, ""});
  ResidualTrainer trainer(device, sdf, samples, std::move(radiance), options);
  train(trainer, std::max(1, options.steps), options.seconds, options.clock, progress);
  return trainer.take();
}

}  // namespace cei3d
