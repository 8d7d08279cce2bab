// SPDX-License-Identifier: Apache-2.0
// A box whose color is a network over position and direction.
#include "engine/reconstruct/coupled_stages.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "core/math/rng.h"
#include "engine/reconstruct/test_run.h"
#include "engine/render/render.h"

namespace cei3d {
namespace {

struct Made {
  Scene scene;
  std::vector<std::string> stages;
};

Made made(const Device& device, const BoxCapture& box) {
  Preset preset = shrunken(preset_by_name("fast"));
  preset.color = ColorChoice::coupled;
  preset.residual_steps = 400;
  ReconstructOptions options;
  options.iterations = 200;
  options.seed = 5;
  VirtualClock time(0.7);
  MemoryCheckpoints checkpoints;
  ScriptedProgress progress;
  Scene scene = reconstruct({.device = device,
                             .capture = box.capture(),
                             .images = box,
                             .normalization = {},
                             .options = options,
                             .preset = preset,
                             .clock = time.clock(),
                             .show = {}},
                            checkpoints, progress);
  return {std::move(scene), progress.stages};
}

TEST(CoupledColor, IsAllThatIsSeenAndThatOfThePhotographs) {
  const Device device = make_device();
  const BoxCapture box;
  const Made object = made(device, box);
  for (const char* stage : {"light", "appearance"})
    EXPECT_EQ(std::count(object.stages.begin(), object.stages.end(), stage), 0) << stage;
  EXPECT_FALSE(object.scene.explained);
  const View& view = box.capture().views[2];
  const Frame f = shade_view(device, object.scene, trace_view(device, object.scene, view.camera, 1));
  const Image photo = box.load(view);
  double error = 0, all = 0;
  for (size_t p = 0; p < f.mask.data.size(); ++p)
    for (int c = 0; c < 3; ++c) {
      const size_t k = 4 * p + size_t(c);
      EXPECT_EQ(f.diffuse.data[k], 0);
      EXPECT_EQ(f.specular.data[k], 0);
      EXPECT_TRUE(std::isfinite(f.rgb.data[k]));
      if (f.mask.data[p] < 0.99f || photo.data[4 * p + 3] < 0.99f) continue;
      error += square(double(f.rgb.data[k]) - double(photo.data[k]));
      all += square(double(photo.data[k]));
    }
  EXPECT_GT(all, 0);
  EXPECT_LT(error, 0.5 * all);  // what is black has an error of 1
}

// Two views of each point see colors whose mean is known.
TEST(CoupledColor, TheAlbedoIsTheMeanOverDirections) {
  std::vector<Hit> hits;
  std::vector<Vec3f> colors;
  for (uint64_t i = 0; i < 500; ++i) {
    Rng rng(1, 0, i);
    const Vec3f n = normalize(Vec3f{rng.normal(), rng.normal(), rng.normal()});
    for (const float shine : {-0.2f, 0.2f}) {
      hits.push_back({n * 0.5f, n, n, 0, 0, 0});
      colors.push_back(Vec3f{0.3f, 0.5f, 0.4f} + Vec3f{0.1f, 0, 0} * n.x + Vec3f{1, 1, 1} * shine);
    }
  }
  FieldConfig config;
  config.output_activation = Activation::sigmoid;
  Progress quiet;
  const Device device = make_device();
  const auto field = mean_colors(device, {hits, colors, {}}, config, 3, quiet);
  const std::vector<Vec3f> got = field->eval3(device, positions_of(hits));
  double worst = 0;
  for (size_t i = 0; i < hits.size(); ++i)
    for (int c = 0; c < 3; ++c)
      worst = std::max(worst, double(std::abs(got[i][c] - (c == 0   ? 0.3f + 0.1f * hits[i].normal.x
                                                           : c == 1 ? 0.5f
                                                                    : 0.4f))));
  EXPECT_LT(worst, 0.06);
}

}  // namespace
}  // namespace cei3d
