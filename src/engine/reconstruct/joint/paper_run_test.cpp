// SPDX-License-Identifier: Apache-2.0
// The paper's way to reconstruct, small: a ball that a path tracer has drawn, from a sphere of another size
// and a light of which nothing is known.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "core/math/color.h"
#include "engine/reconstruct/test_run.h"
#include "engine/render/render.h"

namespace cei3d {
namespace {

constexpr float kBallRadius = 0.75f;

class BallCapture : public DrawnCapture {
 public:
  BallCapture() {
    SyntheticScene ball;
    ball.shape = ball_shape(kBallRadius);
    ball.finishes = finish_set("plastic", ball.shape.regions);
    ball.light = light_by_name("daylight");
    const std::vector<Camera> cameras = spread_cameras(18, {36, 36, 50});
    for (size_t v = 0; v < cameras.size(); ++v)
      add(cameras[v], draw(ball, cameras[v], {.samples = 16, .view = v}).color);
  }
};

// The preset with networks and batches that a test can train, and rates for as few steps.
Preset small_paper() {
  Preset p = preset_by_name("paper");
  FieldConfig& sdf = p.geometry.sdf;
  sdf.encoding.frequencies = 3;
  sdf.hidden_layers = 4;
  sdf.width = 48;
  sdf.skip_layer = 2;
  p.appearance.albedo.encoding.frequencies = 4;
  p.appearance.albedo.hidden_layers = 2;
  p.appearance.albedo.width = 48;
  p.joint.rays = p.joint.mask_rays = p.joint.box_points = 192;
  p.joint.rates.sdf_layers = 2e-3f;
  p.joint.rates.albedo = 1;
  p.joint.rates.material = 1e-2f;
  p.joint.rates.light = 1;
  p.joint.schedule.halving_parts = 3;
  p.meshing.resolution = p.finer_meshing.resolution = 48;
  return p;
}

double psnr_over_white(const Image& got, const Image& truth) {
  double sum = 0;
  const auto shown = [](const float* p, int c) { return srgb_from_linear(p[c]) * p[3] + 1 - p[3]; };
  for (int y = 0; y < truth.height; ++y)
    for (int x = 0; x < truth.width; ++x)
      for (int c = 0; c < 3; ++c) sum += square(double(shown(got.at(x, y), c) - shown(truth.at(x, y), c)));
  return -10 * std::log10(sum / (3.0 * truth.width * truth.height));
}

// Mean loss of colors in the logged lines [first, last).
double color_loss(const std::vector<Json>& lines, double first, double last) {
  std::vector<double> all;
  for (const Json& line : lines)
    if (line.at("stage") == "joint descent" && line.contains("color"))
      all.push_back(line.at("color").get<double>());
  double sum = 0;
  const auto begin = size_t(first * double(all.size())), end = size_t(last * double(all.size()));
  for (size_t i = begin; i < end; ++i) sum += all[i] / double(end - begin);
  return sum;
}

TEST(PaperRun, FindsBallAndLightFromASphere) {
  const BallCapture capture;
  const Device device = make_device();
  ReconstructOptions options;
  options.iterations = 600;
  ScriptedProgress progress;
  MemoryCheckpoints checkpoints;
  const Scene scene = reconstruct({.device = device,
                                   .capture = capture.capture(),
                                   .images = capture,
                                   .normalization = {},
                                   .options = options,
                                   .preset = small_paper()},
                                  checkpoints, progress);
  // The pictures follow the Fresnel equations, eq. 14 a power of two: some of the loss stays.
  EXPECT_LT(color_loss(progress.lines, 0.8, 1), 0.42 * color_loss(progress.lines, 0, 0.2));
  double off = 0;
  for (const Vec3f p : scene.surface->mesh().positions)
    off += std::abs(double(length(p)) - kBallRadius) / double(scene.surface->mesh().positions.size());
  EXPECT_LT(off, 0.05);  // no camera sees the bottom
  for (const View& view : capture.capture().views) {
    if (view.split == Split::train) continue;
    const Frame frame = shade_view(device, scene, trace_view(device, scene, view.camera));
    EXPECT_GT(psnr_over_white(frame.rgb, capture.load(view)), 22) << view.name;
  }
}

}  // namespace
}  // namespace cei3d
