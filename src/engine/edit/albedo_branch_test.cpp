// SPDX-License-Identifier: Apache-2.0
#include "engine/edit/albedo_branch.h"

#include <gtest/gtest.h>

#include <cmath>

#include "core/math/rng.h"

namespace cei3d {
namespace {

// A trained network over frequencies, as of the paper, and points that are painted red.
struct Painted {
  Painted() : trained(config(), 3) {
    for (uint64_t i = 0; i < 400; ++i) {
      Rng rng(1, 0, i);
      samples.positions.push_back({0.3f * rng.uniform(), 0.3f * rng.uniform(), 0.5f});
      samples.targets.push_back({0.8f, 0.1f, 0.1f});
    }
    samples.pixel = 0.01f;
    samples.trained = &trained;
  }
  static FieldConfig config() {
    FieldConfig c;
    c.encoding.frequencies = 4;
    c.hidden_layers = 3;
    c.width = 64;
    c.activation = Activation::elu;
    c.output_activation = Activation::sigmoid;
    return c;
  }
  double error(const Field& branch) const {  // mean, of a channel
    double sum = 0;
    const std::vector<Vec3f> got = branch.eval3(device, samples.positions);
    for (size_t i = 0; i < got.size(); ++i)
      for (int c = 0; c < 3; ++c)
        sum += std::abs(double(got[i][c] - samples.targets[i][c])) / (3.0 * double(got.size()));
    return sum;
  }

  Device device = make_device();
  Field trained;
  BranchSamples samples;
  Progress quiet;
};

TEST(AlbedoBranch, BeginsAsACopyOfTheTrainedNetwork) {
  Painted p;
  const BranchOptions none{.steps = 1, .layer_rate = 0, .start = BranchStart::trained};
  const auto branch = fit_branch(p.device, p.samples, none, 7, p.quiet);
  ASSERT_EQ(branch->params().all().size(), p.trained.params().all().size());
  for (size_t t = 0; t < branch->params().all().size(); ++t)
    EXPECT_EQ(branch->params().all()[t].value, p.trained.params().all()[t].value);
}

// 500 steps at the constant rate 5e-4. [paper sec. 5.1]
TEST(AlbedoBranch, LearnsThePaintAsThePaperDoes) {
  Painted p;
  const double before = p.error(p.trained);
  const BranchOptions paper{.steps = 500,
                            .batch = 256,
                            .layer_rate = 5e-4f,
                            .decay = false,
                            .start = BranchStart::trained,
                            .loss = BranchLoss::l1};
  const auto branch = fit_branch(p.device, p.samples, paper, 7, p.quiet);
  EXPECT_GT(before, 0.3);
  EXPECT_LT(p.error(*branch), 0.02);
}

}  // namespace
}  // namespace cei3d
