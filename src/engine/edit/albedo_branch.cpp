// SPDX-License-Identifier: Apache-2.0
#include "engine/edit/albedo_branch.h"

#include <algorithm>
#include <bit>

#include "core/base/cancel.h"
#include "core/math/loss.h"
#include "core/math/rng.h"

namespace cei3d {
namespace {

// Finest cells of half a pixel and a table that holds those on the stroke, so that borders between two colors
// stay as sharp as in the scribble.
FieldConfig branch_config(const BranchSamples& samples, const BranchOptions& options) {
  FieldConfig c;
  c.encoding.levels = options.levels;
  c.encoding.base_resolution = 16;
  c.encoding.finest_resolution = int(clamp(4 / samples.pixel, 64.0f, 4096.0f));
  c.encoding.log2_table = std::clamp(int(std::bit_width(samples.positions.size())), 14, 16);
  c.hidden_layers = options.hidden_layers;
  c.width = options.width;
  c.outputs = 3;
  c.output_activation = Activation::sigmoid;
  return c;
}

// A batch drawn with replacement, a function of seed and step.
struct Batch {
  std::vector<Vec3f> x, target;

  Batch(const BranchSamples& s, size_t size, uint64_t seed, int step) : x(size), target(size) {
    for (size_t i = 0; i < size; ++i) {
      const uint32_t k = Rng(seed, step, i).below(uint32_t(s.positions.size()));
      x[i] = s.positions[k];
      target[i] = s.targets[k];
    }
  }
};

// The sum over all channels of a loss of a channel and of the one that is wanted, over `count`.
template <class Loss>
FieldTrainer::Loss mean_loss(const std::vector<Vec3f>& target, float count, const Loss& loss) {
  return [&target, count, loss](int begin, int end, const float* out, float* d_out) {
    for (int i = begin; i < end; ++i)
      for (int c = 0; c < 3; ++c) {
        const int k = 3 * (i - begin) + c;
        d_out[k] = loss(out[k], target[i][c]).gradient / count;
      }
  };
}

// Mean over the points.
FieldTrainer::Loss cross_entropy_of(const std::vector<Vec3f>& target) {
  return mean_loss(target, float(target.size()),
                   [](float y, float wanted) { return cross_entropy(y, wanted); });
}

SettingTable<BranchOptions> make_settings() {
  SettingTable<BranchOptions> table;
  SettingGroup<BranchOptions, BranchOptions>(table, "branch.",
                                             [](BranchOptions& o) -> BranchOptions& { return o; })
      .add("steps", &BranchOptions::steps, {1, 1e6}, "steps",
           "Training steps of the branch; the paper has 500", "[paper sec. 5.1]")
      .add("batch", &BranchOptions::batch, {1, 1e6}, "points a step", "Size of a training batch")
      .add("levels", &BranchOptions::levels, {1, 16}, "", "Levels of the branch's hash grid",
           "[Mueller et al. 2022]")
      .add("hidden_layers", &BranchOptions::hidden_layers, {0, 8}, "", "Hidden layers of the branch")
      .add("width", &BranchOptions::width, {1, 512}, "neurons", "Width of a hidden layer")
      .add("table_rate", &BranchOptions::table_rate, {0, 1}, "", "Learning rate of the hash tables",
           "[Kingma and Ba 2015]")
      .add("layer_rate", &BranchOptions::layer_rate, {0, 1}, "", "Learning rate of the layers",
           "[Kingma and Ba 2015]")
      .add("decay", &BranchOptions::decay, {}, "",
           "Let rates fall along half a cosine; else they are constant")
      .choice("start", &BranchOptions::start,
              {{BranchStart::small, "small"}, {BranchStart::trained, "trained"}},
              "A small new network, or a copy of the trained albedo network, which is the paper's",
              "[paper sec. 4.2]")
      .choice("loss", &BranchOptions::loss,
              {{BranchLoss::cross_entropy, "cross_entropy"}, {BranchLoss::l1, "l1"}},
              "Loss of the painted colors; l1 is the paper's", "[paper eq. 17]");
  return table;
}

}  // namespace

FieldTrainer::Loss absolute_difference(const std::vector<Vec3f>& target) {
  return mean_loss(target, 3 * float(target.size()),
                   [](float y, float wanted) { return absolute(y - wanted); });
}

const SettingTable<BranchOptions>& branch_settings() {
  static const SettingTable<BranchOptions> table = make_settings();
  return table;
}

std::shared_ptr<const Field> fit_branch(const Device& device, const BranchSamples& s,
                                        const BranchOptions& options, uint64_t seed, Progress& progress) {
  const bool copies = options.start == BranchStart::trained && s.trained;
  auto field =
      copies ? std::make_shared<Field>(*s.trained) : std::make_shared<Field>(branch_config(s, options), seed);
  FieldTrainer trainer(*field, {.encoding_rate = options.table_rate, .network_rate = options.layer_rate});
  for (int step = 0; step < options.steps; ++step) {
    check_cancelled(progress, "Painting was interrupted; nothing was changed.");
    const float fraction = float(step) / float(options.steps);
    const Batch batch(s, size_t(options.batch), seed, step);
    trainer.step(
        device, batch.x,
        options.loss == BranchLoss::l1 ? absolute_difference(batch.target) : cross_entropy_of(batch.target),
        options.decay ? cosine_decay(fraction) : 1);
    if (step % 40 == 0) progress.report({"paint", 0.2 + 0.8 * fraction, -1, ""});
  }
  return field;
}

std::shared_ptr<const Field> uniform_branch(Vec3f color) {
  FieldConfig c;
  c.hidden_layers = 0;
  auto field = std::make_shared<Field>(c, 0);
  for (Param& p : field->params().all()) std::fill(p.value.begin(), p.value.end(), 0.0f);
  Param& bias = field->params().all().back();
  for (int i = 0; i < 3; ++i) bias.value[i] = color[i];
  return field;
}

}  // namespace cei3d
