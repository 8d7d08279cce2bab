// SPDX-License-Identifier: Apache-2.0
#include "engine/reconstruct/presets.h"

#include <algorithm>
#include <cmath>

#include "core/base/error.h"

namespace cei3d {

namespace {

constexpr int kFeatures = 16;  // what the SDF network tells the radiance network

Preset fast() {
  Preset p;
  FieldConfig& sdf = p.geometry.sdf;
  sdf.encoding = {0, 14, 16, 384, 15};
  sdf.hidden_layers = 1;
  sdf.width = 64;
  sdf.activation = Activation::softplus;
  sdf.outputs = 1 + kFeatures;
  sdf.sphere_radius = 0.5f;
  p.albedo.encoding = {0, 12, 16, 384, 16};
  p.albedo.hidden_layers = 1;
  p.albedo.width = 32;
  p.albedo.activation = Activation::relu;
  p.albedo.outputs = 3;
  p.albedo.output_activation = Activation::sigmoid;
  p.iterations = 4000;
  p.resolution_from_views = true;
  return p;
}

Preset paper() {
  Preset p;
  FieldConfig& sdf = p.geometry.sdf;
  sdf.encoding.frequencies = 6;
  sdf.hidden_layers = 8;
  sdf.width = 512;
  sdf.skip_layer = 4;
  sdf.activation = Activation::softplus;
  sdf.softplus_beta = 100;
  sdf.outputs = 1 + kFeatures;
  sdf.sphere_radius = 0.5f;
  p.geometry.radiance_layers = 4;
  p.geometry.radiance_width = 512;
  p.geometry.layer_rate = 5e-4f;
  p.geometry.prefit_steps = 1000;
  p.albedo.encoding.frequencies = 10;
  p.albedo.hidden_layers = 4;
  p.albedo.width = 512;
  p.albedo.activation = Activation::elu;
  p.albedo.outputs = 3;
  p.albedo.output_activation = Activation::sigmoid;
  p.iterations = 200000;
  p.resolution_from_views = false;
  return p;
}

}  // namespace

Preset preset_by_name(const std::string& name) {
  if (name == "fast") return fast();
  if (name == "paper") return paper();
  if (name == "balanced") {
    Preset p = fast();
    p.iterations = 16000;
    return p;
  }
  fail_usage("unknown preset '{}': fast, balanced or paper", name);
}

void fit_to_footprint(Preset& p, double footprint) {
  if (!p.resolution_from_views) return;
  const int finest = int(std::clamp(2.2 / footprint, 96.0, 640.0));  // cells a little finer than pixels
  EncodingConfig &sdf = p.geometry.sdf.encoding, &albedo = p.albedo.encoding;
  sdf.finest_resolution = albedo.finest_resolution = finest;
  sdf.log2_table = finest > 330 ? 17 : 15;
  albedo.log2_table = finest > 330 ? 19 : 16;
  p.meshing.resolution = finest > 330 ? 256 : finest > 140 ? 192 : 96;
}

}  // namespace cei3d
