// SPDX-License-Identifier: Apache-2.0
#include "engine/reconstruct/presets.h"

#include <algorithm>
#include <cmath>

#include "core/base/error.h"

namespace cei3d {

namespace {

constexpr float kPaperRate = 5e-4f;
constexpr int kFeatures = 16;  // outputs of the SDF network that the radiance network reads

Preset fast() {
  Preset p;
  FieldConfig& sdf = p.geometry.sdf;
  sdf.encoding = {0, 14, 16, 384, 15};
  sdf.hidden_layers = 1;
  sdf.width = 64;
  sdf.activation = Activation::softplus;
  sdf.outputs = 1 + kFeatures;
  sdf.sphere_radius = 0.5f;
  p.appearance.albedo.encoding = {0, 12, 16, 384, 16};
  p.appearance.albedo.hidden_layers = 1;
  p.appearance.albedo.width = 32;
  p.appearance.albedo.activation = Activation::relu;
  p.appearance.albedo.outputs = 3;
  p.appearance.albedo.output_activation = Activation::sigmoid;
  p.appearance.materials = p.appearance.albedo;
  p.appearance.materials.encoding = {0, 10, 16, 256, 14};
  p.appearance.materials.outputs = MaterialField::kOutputs;
  p.trial.geometry = p.geometry;
  p.iterations = 4000;
  p.resolution_from_views = true;
  return p;
}

// Two hidden layers of 64 for the distance and for the albedo, hash tables four times as large, and more
// steps.
Preset balanced() {
  Preset p = fast();
  p.geometry.sdf.hidden_layers = 2;
  p.appearance.albedo.hidden_layers = 2;
  p.appearance.albedo.width = 64;
  p.larger_tables = 2;
  p.iterations = 16000;
  return p;
}

// The descent of sec. 5.1, in whose text beta is the weight of the eikonal term. The mask loss and its weight
// are those of [Yariv et al. 2020]; half of the pixels of a batch show the object.
JointOptions paper_descent() {
  JointOptions o;
  o.rates = {.sdf_tables = kPaperRate,
             .sdf_layers = kPaperRate,
             .albedo = 0.25f,
             .material = kPaperRate,
             .light = 0.05f};
  o.schedule = {.warm_up = 0, .halving_parts = 8};
  o.adam = {.beta2 = 0.999f, .eps = 1e-8f};
  o.weight_norm = true;
  o.color = ColorLoss::linear;
  o.specular = SpecularTerm::single_sg;
  o.rays = o.mask_rays = o.box_points = 1024;
  o.near_points = 0;
  o.mask = 0.5f;
  o.mask_sharpness = 200;
  o.keep_power = false;
  return o;
}

Preset paper() {
  Preset p;
  p.start = StartChoice::sphere;
  p.stages = StageChoice::joint;
  p.joint = paper_descent();
  FieldConfig& sdf = p.geometry.sdf;
  sdf.encoding.frequencies = 6;
  sdf.hidden_layers = 8;
  sdf.width = 512;
  sdf.skip_layer = 4;
  sdf.activation = Activation::softplus;
  sdf.softplus_beta = 100;
  sdf.outputs = 1;
  p.trial.geometry = fast().geometry;
  p.geometry.layer_rate = kPaperRate;
  p.appearance.albedo.encoding.frequencies = 10;
  p.appearance.albedo.hidden_layers = 4;
  p.appearance.albedo.width = 512;
  p.appearance.albedo.activation = Activation::elu;
  p.appearance.albedo.outputs = 3;
  p.appearance.albedo.output_activation = Activation::sigmoid;
  p.appearance.materials = p.appearance.albedo;
  p.appearance.materials.width = 128;
  p.appearance.materials.outputs = MaterialField::kOutputs;
  p.meshing.resolution = 128;
  p.finer_meshing.resolution = 256;
  p.iterations = 200000;
  p.brief_hits = 200000;
  return p;
}

}  // namespace

Preset preset_by_name(const std::string& name) {
  if (name == "fast") return fast();
  if (name == "paper") return paper();
  if (name == "balanced") return balanced();
  fail_usage("There is no preset '{}'; the presets are fast, balanced and paper.", name);
}

void fit_to_footprint(Preset& p, double footprint) {
  const int finest = int(std::clamp(2.2 / footprint, 96.0, 640.0));  // cells a little finer than pixels
  const bool fine = finest > 330;
  const auto fit = [&](EncodingConfig& grid, int log2_table) {
    grid.finest_resolution = finest;
    grid.log2_table = log2_table;
  };
  fit(p.trial.geometry.sdf.encoding, fine ? 17 : 15);
  if (!p.resolution_from_views) return;
  fit(p.geometry.sdf.encoding, (fine ? 17 : 15) + p.larger_tables);
  fit(p.appearance.albedo.encoding, (fine ? 19 : 16) + p.larger_tables);
  fit(p.appearance.materials.encoding, fine ? 17 : 15);
  p.meshing.resolution = fine ? 256 : finest > 140 ? 192 : 96;
  p.finer_meshing.resolution = p.meshing.resolution * 3 / 2;
}

}  // namespace cei3d
