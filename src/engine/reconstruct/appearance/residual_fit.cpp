// SPDX-License-Identifier: Apache-2.0
#include "engine/reconstruct/appearance/residual_fit.h"

#include <array>
#include <cmath>

#include "core/base/cancel.h"
#include "core/base/json.h"
#include "core/base/parallel.h"
#include "core/base/pool.h"
#include "core/math/loss.h"
#include "core/math/psnr.h"
#include "core/math/rng.h"
#include "engine/reconstruct/appearance/shaded_samples.h"
#include "model/field/gradients.h"
#include "model/field/optimizer.h"

namespace cei3d {

namespace {

constexpr int kChunks = 16, kBatch = kChunks * ResidualPass::kMaxHits;  // pixels per step
constexpr int kValidationStride = 8;  // one in so many views is held back for validation
constexpr size_t kMaxValidationPixels = 100000;
constexpr size_t kSlab = 1 << 15;  // hits between two checks for interruption: 5 s with the largest networks
// Minimum relative decrease of the squared error on the views held back. Light and material were fitted to
// these views, too, and the network was not. Where they explain photographs badly, the network gains more on
// views that neither has seen than these show (docs/notebook/0043-samples-by-the-patch.md).
constexpr double kMinGain = 0.03, kMinGainIfBad = -0.05;
constexpr double kBad = 30;                  // dB
constexpr double kValidationFraction = 0.2;  // share of the steps before the validation
constexpr double kWarmUp = 0.05;  // share of the steps at rising rates: large first steps leave dead units

class ResidualTrainer {
 public:
  ResidualTrainer(const Device& device, const Scene& scene, const SurfaceSamples& samples,
                  std::span<const uint16_t> views, const ResidualOptions& options, const Progress& progress)
      : device_(device),
        samples_(samples),
        seed_(options.seed),
        warm_up_(kWarmUp * options.steps),
        radiance_(options.alone ? std::vector<Vec3f>(samples.hits.size(), Vec3f{0, 0, 0})
                                : radiance_of(device, scene, samples, progress)),
        features_(std::make_shared<Field>(*scene.sdf)),
        features_learn_(features_->config().encoding.levels > 0),
        residual_(make_residual(features_learn_ ? features_ : scene.sdf, options.seed)),
        passes_([this] { return std::make_unique<ResidualPass>(features_->config(), residual_.network); }) {
    optimizer_.add(residual_.params, "", {.rate = options.rate});
    if (features_learn_) {
      optimizer_.add(features_->params(), "encoding/", {.rate = options.table_rate, .skip_zero = true});
      optimizer_.add(features_->params(), "layer", {.rate = options.feature_rate});
    }
    for (uint32_t i = 0; i < views.size(); ++i)
      (views[i] % kValidationStride == kValidationStride - 1 ? validation_ : training_).push_back(i);
  }
  bool can_judge() const { return !validation_.empty() && !training_.empty(); }
  void teach_all() { training_.insert(training_.end(), validation_.begin(), validation_.end()); }

  // PSNR of the views held back.
  Explained explained(const Progress& progress) const {
    std::vector<uint32_t> judged;
    for (size_t i = 0; i < validation_.size(); i += 1 + validation_.size() / kMaxValidationPixels)
      judged.push_back(validation_[i]);
    double with = 0, without = 1e-12;
    for (size_t begin = 0; begin < judged.size(); begin += kSlab) {
      check_cancelled(progress);
      std::vector<Hit> hits;
      const std::span some = std::span(judged).subspan(begin, std::min(kSlab, judged.size() - begin));
      for (const uint32_t s : some) hits.push_back(hit(s));
      const std::vector<Vec3f> values = residual_at(device_, residual_, hits);
      for (size_t i = 0; i < some.size(); ++i) {
        with += display_error(radiance_[some[i]] + values[i], samples_.colors[some[i]]);
        without += display_error(radiance_[some[i]], samples_.colors[some[i]]);
      }
    }
    const auto psnr = [&](double sum) { return psnr_of_mse(sum / (3 * double(judged.size()))); };
    return {psnr(without), psnr(with)};
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
      out[i] =
          Rng(seed_, uint64_t(steps_), uint64_t(chunk) * out.size() + i).below(uint32_t(training_.size()));
    for (uint32_t& i : out) i = training_[i];
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
  std::vector<uint32_t> training_, validation_;  // samples
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

ResidualFit fit_residual(const Device& device, const Scene& scene, const SurfaceSamples& samples,
                         std::span<const uint16_t> views, const ResidualOptions& options,
                         Progress& progress) {
  const double start = options.clock();
  progress.report({"residual", 0, -1, ""});
  ResidualTrainer trainer(device, scene, samples, views, options, progress);
  if (options.alone) {
    trainer.teach_all();
    train(trainer, std::max(1, options.steps), options.seconds, options.clock, progress);
    return {trainer.take(), {}};
  }
  if (!trainer.can_judge()) return {};
  const double shading = options.clock() - start;
  const double seconds = options.seconds > 0 ? std::max(options.seconds - shading, 0.5 * options.seconds) : 0;
  const int judging = std::max(1, int(kValidationFraction * options.steps));
  train(trainer, judging, kValidationFraction * seconds, options.clock, progress);
  const Explained explained = trainer.explained(progress);
  const double gain = 1 - std::pow(10, 0.1 * (explained.physical - explained.with_residual));
  progress.log(Json{
      {"stage", "residual"},
      {"shading", shading},
      {"physical", explained.physical},
      {"with_residual", explained.with_residual},
      {"gain_on_views_kept_apart",
       gain}}.dump());
  if (gain < (explained.physical < kBad ? kMinGainIfBad : kMinGain)) return {{}, explained};
  trainer.teach_all();
  train(trainer, options.steps - judging, (1 - kValidationFraction) * seconds, options.clock, progress);
  return {trainer.take(), explained};
}

}  // namespace cei3d
