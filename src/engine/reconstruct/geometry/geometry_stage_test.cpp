// SPDX-License-Identifier: Apache-2.0
#include "engine/reconstruct/geometry/geometry_stage.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "engine/reconstruct/start/start.h"
#include "engine/reconstruct/test_box.h"

namespace cei3d {
namespace {

PixelStore photographs() {
  PixelStore store;
  for (int v = 0; v < 12; ++v) {
    const Camera camera = box_camera(-0.4 + 0.08 * v, 2.4 * v, 48);
    store.add_view(camera,
                   box_picture(camera,
                               [](Vec3f p) {
                                 return p.x > 0 ? Vec3f{1, 0, 0} : Vec3f{0, 0, 1};
                               }),
                   4);
  }
  return store;
}

// One network for all of space, without a table.
GeometryOptions small_network() {
  GeometryOptions o;
  o.sdf.encoding.frequencies = 4;
  o.sdf.hidden_layers = 2;
  o.sdf.width = 32;
  o.sdf.activation = Activation::softplus;
  o.sdf.outputs = 5;
  o.sdf.sphere_radius = 0.5f;
  o.radiance_width = 16;
  o.rays = 256;
  o.prefit_steps = 400;
  return o;
}

// Mean distance between field and start around the start's surface after some steps, in which an unfamiliar
// rate throws the network about.
double strayed(const PixelStore& pixels, GeometryOptions options) {
  const Device device = make_device();
  options.layer_rate = 5e-3f;
  GeometryStage stage(device, pixels, options, 1);
  const StartShape start = start_shape(pixels, Start::hull, 1);
  stage.prefit(start);
  for (int step = 0; step < 60; ++step) stage.step(step, 0.05);
  std::vector<Vec3f> x;
  for (uint64_t i = 0; x.size() < 2000; ++i) {
    Rng rng(3, 0, i);
    const Vec3f p{2 * rng.uniform() - 1, 2 * rng.uniform() - 1, 2 * rng.uniform() - 1};
    if (std::abs(start.distance.at(p)) < 0.08f) x.push_back(p);
  }
  const std::vector<float> values = first_output(device, stage.sdf(), x);
  double sum = 0;
  for (size_t i = 0; i < x.size(); ++i) sum += std::abs(values[i] - start.distance.at(x[i]));
  return sum / double(x.size());
}

TEST(GeometryStage, ResumedFromItsCheckpointTakesTheSameStep) {
  const PixelStore pixels = photographs();
  const Device device = make_device();
  GeometryOptions options = small_network();
  options.sdf.encoding = {
      .frequencies = 0, .levels = 2, .base_resolution = 4, .finest_resolution = 9, .log2_table = 9};
  options.prefit_steps = 10;
  StartShape start = start_shape(pixels, Start::hull, 1);
  start.anchored = true;
  start.matte_until = 0.1f;
  GeometryStage stage(device, pixels, options, 1), resumed(device, pixels, options, 1);
  stage.prefit(start);
  LightFrame light{LightMotion::turntable, {0, 0, 1}};
  light.rings = {{{0, 0, 1}, -0.5f, 0.02f}, {{0, 1, 0}, -0.4f, 0}};
  stage.set_light(light);
  for (int step = 0; step < 3; ++step) stage.step(step, 0.05);
  Tensors checkpoint, want, got;
  stage.save(checkpoint);
  for (const char* name : {"sdf/encoding/level0", "sdf/layer0/weight", "radiance/layer0/bias", "adam/0/m",
                           "adam/steps", "pixel_errors", "matte_until", "anchor", "occupancy"})
    EXPECT_TRUE(checkpoint.contains(name)) << name;
  resumed.load(checkpoint);
  stage.step(3, 0.05);
  resumed.step(3, 0.05);
  stage.save(want);
  resumed.save(got);
  ASSERT_EQ(got.size(), want.size());
  for (Tensors* tensors : {&want, &got})  // cells beyond the unit sphere begin at 4 and come back as 3.9
    for (float& d : (*tensors)["occupancy"].f32) d = std::min(d, 3.8f);
  for (const auto& [name, tensor] : want) EXPECT_EQ(got[name].f32, tensor.f32) << name;
}

TEST(GeometryStage, HoldsItsStartWhereItIsTold) {
  const PixelStore pixels = photographs();
  GeometryOptions held = small_network();
  held.hold_start = true;
  EXPECT_LT(strayed(pixels, held), 0.6 * strayed(pixels, small_network()));
}

}  // namespace
}  // namespace cei3d
